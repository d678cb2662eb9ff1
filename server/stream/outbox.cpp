#include "server/stream/outbox.hpp"

namespace server {

void Outbox::remove(Frame& frame) {
  if (!frame) return;
  bytes_ -= frame->size();
  frame.reset();
}

void Outbox::put(std::size_t slot, Frame frame) {
  Frame& here = slots_.at(slot);
  remove(here);
  if (bytes_ + frame->size() > limits_.bytes) {
    ++dropped_;
    return;
  }
  bytes_ += frame->size();
  here = std::move(frame);
}

void Outbox::push(Frame frame) {
  if (frame->size() > limits_.bytes) {
    ++dropped_;
    return;
  }
  for (std::size_t i = slots_.size(); i-- > 0 && bytes_ + frame->size() > limits_.bytes;) {
    if (slots_[i]) ++dropped_;
    remove(slots_[i]);
  }
  while (!events_.empty() && (events_.size() >= limits_.events || bytes_ + frame->size() > limits_.bytes)) {
    remove(events_.front());
    events_.pop_front();
    ++dropped_;
  }
  bytes_ += frame->size();
  events_.push_back(std::move(frame));
}

bool Outbox::push_first(Frame frame) {
  constexpr std::size_t most = 64;
  if (first_.size() >= most) return false;
  bytes_ += frame->size();
  first_.push_back(std::move(frame));
  return true;
}

void Outbox::clear(std::size_t slot) { remove(slots_.at(slot)); }

Frame Outbox::take() {
  const auto pop = [&](std::deque<Frame>& queue) {
    Frame frame = std::move(queue.front());
    queue.pop_front();
    bytes_ -= frame->size();
    return frame;
  };
  if (!first_.empty()) return pop(first_);
  if (!events_.empty()) return pop(events_);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Frame& here = slots_[(next_slot_ + i) % slots_.size()];
    if (!here) continue;
    next_slot_ = (next_slot_ + i + 1) % slots_.size();
    bytes_ -= here->size();
    return std::exchange(here, nullptr);
  }
  return nullptr;
}

}  // namespace server
