// Who watches, and what they get. State is encoded once, kept as the newest value for those who come later, and put
// into every subscriber's slot; events get a sequence number and stay in a ring, from which a viewer that was away
// catches up. Belongs to the web thread.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/web/problem.hpp"
#include "server/stream/topics.hpp"
#include "server/stream/web_socket.hpp"

namespace server {

// A viewer: a line, who it is, and what it wants to see.
struct Viewer {
  std::shared_ptr<WebSocket> socket;
  std::string session;
  TopicSet topics = default_topics();
  std::uint64_t joined = 0;  // the last event before it came
};

struct HubStatistics {
  std::uint64_t frames = 0;       // encoded
  std::uint64_t deliveries = 0;   // handed to viewers
  std::uint64_t dropped = 0;      // events and pictures that viewers were too slow for
  std::size_t waiting_bytes = 0;  // over all viewers
};

class Hub {
 public:
  using Json = protocols::web::Json;

  // `epoch` names this run: sequence numbers of another one mean nothing. `cameras`: their ids, at most 49.
  Hub(std::string epoch, std::vector<std::string> cameras);

  std::size_t slots() const { return fixed_topics + cameras_.size(); }
  const std::string& epoch() const { return epoch_; }
  std::uint64_t seq() const { return seq_; }
  std::size_t viewers() const { return viewers_.size(); }
  bool wanted(std::size_t topic) const { return watching_.at(topic) > 0; }
  bool wanted(Topic topic) const { return wanted(index(topic)); }

  // The viewer gets hello (`hello` with epoch and seq added) and the newest state. Keep the pointer for leave().
  void join(const std::shared_ptr<Viewer>& viewer, Json hello);
  void leave(const std::shared_ptr<Viewer>& viewer);
  // A text message of a viewer: subscribe, resume, ping.
  void receive(Viewer& viewer, const std::string& text);

  // Newest wins. Text messages are JSON; binary ones are payloads.
  void state(std::size_t topic, const Json& message);
  void state_binary(std::size_t topic, std::string_view head, std::string_view body = {});
  // State in which the viewers of some sessions see something of their own.
  void state(std::size_t topic, const Json& message, const std::map<std::string, Json>& own);
  // An event; viewers of the session `owner` (when not empty) get `own` instead.
  void event(Topic topic, Json message, const std::string& owner = {}, Json own = {});

  // Tells viewers who lag how much they missed. Call about once a second.
  void tell_laggards();
  // Ends every line.
  void close_all(std::uint16_t code, std::string_view reason);

  HubStatistics statistics() const;

 private:
  struct Past {
    std::uint64_t seq;
    Topic topic;
    Frame frame;
    std::string owner;
    Frame own;
  };

  void send(std::size_t topic, const Frame& frame);
  void subscribe(Viewer& viewer, const std::vector<std::string>& names);
  void resume(Viewer& viewer, const std::string& epoch, std::uint64_t last_seq);
  void send_newest(Viewer& viewer, std::size_t topic);
  void count(const TopicSet& topics, int change);

  std::string epoch_;
  std::vector<std::string> cameras_;
  std::vector<std::shared_ptr<Viewer>> viewers_;
  std::vector<int> watching_;                      // viewers a topic
  std::vector<Frame> newest_;                      // a state topic
  std::vector<std::map<std::string, Frame>> own_;  // a state topic: session to its own version
  std::deque<Past> past_;
  std::uint64_t seq_ = 0;
  HubStatistics statistics_;
};

}  // namespace server
