// What waits to be sent to one viewer, bounded in every direction. State has one slot a topic in which the newest value
// replaces the unsent one; events stand in a queue whose oldest entries are dropped, and counted, when it is full.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace server {

// A whole WebSocket frame, header and payload: built once, shared by all viewers.
using Frame = std::shared_ptr<const std::string>;

struct OutboxLimits {
  std::size_t bytes = 256 * 1024;  // waiting, all kinds together
  std::size_t events = 256;        // waiting
};

class Outbox {
 public:
  explicit Outbox(std::size_t slots, OutboxLimits limits = {}) : slots_(slots), limits_(limits) {}

  // State: replaces what waits in the slot. A frame that does not fit into the bytes left is dropped.
  void put(std::size_t slot, Frame frame);
  // An event. Makes room by dropping state first, then the oldest events.
  void push(Frame frame);
  // Answers and control frames, ahead of everything. False when too many wait: the client asks faster than it reads.
  bool push_first(Frame frame);
  // Forgets the state that waits in a slot.
  void clear(std::size_t slot);

  // The next frame to send, or null: control, events, then state in turn.
  Frame take();

  bool empty() const { return bytes_ == 0; }
  std::size_t bytes() const { return bytes_; }
  // Events and frames dropped since the last call (replaced state is not a loss).
  std::uint64_t take_dropped() { return std::exchange(dropped_, 0); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  void remove(Frame& frame);

  std::vector<Frame> slots_;
  std::deque<Frame> events_;
  std::deque<Frame> first_;
  OutboxLimits limits_;
  std::size_t next_slot_ = 0;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace server
