// Where requests to the robot wait for their answer. Each event goes out with a ticket of its own; the robot's Answer
// carries it back.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "robot/inputs.hpp"
#include "robot/outputs.hpp"
#include "server/stream/asio.hpp"

namespace server {

class Desk {
 public:
  Desk(net::io_context& context, std::function<void(robot::Event)> submit)
      : context_(context), submit_(std::move(submit)) {}

  // Hands an event with a `ticket` over and waits. None: the robot has not answered in time; with `undo_when_late`,
  // requests that it makes all the same are cancelled, because their asker was told that they were not accepted.
  template <typename Event>
  net::awaitable<std::optional<robot::Answer>> ask(Event event, Clock::duration patience, bool undo_when_late = false) {
    const robot::Ticket ticket = ++last_ticket_;
    event.ticket = ticket;
    Waiting waiting{net::steady_timer(context_, patience), std::nullopt};
    waiting_[ticket] = &waiting;
    // Leaves the table however this frame ends.
    const std::shared_ptr<void> leave(nullptr, [this, ticket](void*) { waiting_.erase(ticket); });
    submit_(std::move(event));
    error_code ignored;
    co_await waiting.ready.async_wait(quietly(ignored));
    if (!waiting.answer && undo_when_late) late_.insert(ticket);
    co_return waiting.answer;
  }

  // Hands over an event that nobody answers.
  void tell(robot::Event event) { submit_(std::move(event)); }

  void take(const robot::Answer& answer) {
    const auto it = waiting_.find(answer.ticket);
    if (it == waiting_.end()) return undo(answer);
    it->second->answer = answer;
    it->second->ready.cancel();
  }

 private:
  struct Waiting {
    net::steady_timer ready;
    std::optional<robot::Answer> answer;
  };

  void undo(const robot::Answer& answer) {
    if (late_.erase(answer.ticket) == 0) return;
    for (const robot::RequestId id : answer.requests) submit_(robot::CancelRequest{0, id, {}, true});
  }

  net::io_context& context_;
  std::function<void(robot::Event)> submit_;
  std::map<robot::Ticket, Waiting*> waiting_;
  std::set<robot::Ticket> late_;
  robot::Ticket last_ticket_ = 0;
};

}  // namespace server
