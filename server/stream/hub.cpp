#include "server/stream/hub.hpp"

#include <algorithm>
#include <stdexcept>

#include "protocols/web/decode.hpp"

namespace server {
namespace {

using protocols::web::Json;
using protocols::web::Opcode;

constexpr std::size_t ring = 1024;  // events kept for those who were away

Frame text_frame(const Json& message) {
  return std::make_shared<const std::string>(protocols::web::encode_frame(Opcode::text, message.dump()));
}

void answer(Viewer& viewer, const Json& message) { viewer.socket->answer(Opcode::text, message.dump()); }

}  // namespace

Hub::Hub(std::string epoch, std::vector<std::string> cameras)
    : epoch_(std::move(epoch)),
      cameras_(std::move(cameras)),
      watching_(most_topics),
      newest_(most_topics),
      own_(most_topics) {
  if (cameras_.size() > most_topics - fixed_topics) throw std::invalid_argument("hub: too many cameras");
}

void Hub::join(const std::shared_ptr<Viewer>& viewer, Json hello) {
  hello["epoch"] = epoch_;
  hello["seq"] = seq_;
  viewer->joined = seq_;
  viewers_.push_back(viewer);
  count(viewer->topics, 1);
  answer(*viewer, hello);
  for (std::size_t topic = 0; topic < slots(); ++topic) {
    if (viewer->topics.test(topic)) send_newest(*viewer, topic);
  }
}

void Hub::leave(const std::shared_ptr<Viewer>& viewer) {
  const auto it = std::find(viewers_.begin(), viewers_.end(), viewer);
  if (it == viewers_.end()) return;
  statistics_.dropped += viewer->socket->take_dropped();
  count(viewer->topics, -1);
  *it = std::move(viewers_.back());
  viewers_.pop_back();
}

void Hub::receive(Viewer& viewer, const std::string& text) {
  auto decoded = protocols::web::decode_client_message(text);
  if (const auto* problem = std::get_if<protocols::web::Problem>(&decoded)) {
    return answer(viewer, {{"type", "error"}, {"code", problem->code}, {"detail", problem->detail}});
  }
  const auto& message = std::get<protocols::web::ClientMessage>(decoded);
  if (const auto* wish = std::get_if<protocols::web::Subscribe>(&message)) {
    subscribe(viewer, wish->topics);
  } else if (const auto* again = std::get_if<protocols::web::Resume>(&message)) {
    resume(viewer, again->epoch, again->last_seq);
  } else {
    answer(viewer, {{"type", "pong"}, {"id", std::get<protocols::web::Ping>(message).id}});
  }
}

void Hub::subscribe(Viewer& viewer, const std::vector<std::string>& names) {
  TopicSet wanted_topics;
  for (const auto& name : names) {
    if (const auto topics = topics_named(name, cameras_)) {
      wanted_topics |= *topics;
    } else {
      answer(viewer, {{"type", "error"}, {"code", "unknown_topic"}, {"detail", "There is no topic '" + name + "'."}});
    }
  }
  const TopicSet before = viewer.topics;
  count(before, -1);
  viewer.topics = wanted_topics;
  count(wanted_topics, 1);
  for (std::size_t topic = 0; topic < slots(); ++topic) {
    if (wanted_topics.test(topic) && !before.test(topic)) send_newest(viewer, topic);
    if (!wanted_topics.test(topic) && before.test(topic)) viewer.socket->forget(topic);
  }
}

void Hub::resume(Viewer& viewer, const std::string& epoch, std::uint64_t last_seq) {
  if (epoch != epoch_) {
    return answer(
        viewer,
        {{"type", "error"}, {"code", "epoch_changed"}, {"detail", "The server has started anew: nothing to resume."}});
  }
  if (!past_.empty() && last_seq + 1 < past_.front().seq) {
    answer(viewer, {{"type", "lagging"}, {"dropped", past_.front().seq - last_seq - 1}});
  }
  for (const Past& past : past_) {
    if (past.seq <= last_seq || past.seq > viewer.joined || !viewer.topics.test(index(past.topic))) continue;
    viewer.socket->event(!past.owner.empty() && past.owner == viewer.session ? past.own : past.frame);
  }
  viewer.joined = std::min(viewer.joined, last_seq);  // asked again, nothing comes twice
}

void Hub::send_newest(Viewer& viewer, std::size_t topic) {
  if (const auto it = own_[topic].find(viewer.session); it != own_[topic].end()) {
    viewer.socket->state(topic, it->second);
  } else if (newest_[topic]) {
    viewer.socket->state(topic, newest_[topic]);
  }
}

void Hub::send(std::size_t topic, const Frame& frame) {
  ++statistics_.frames;
  newest_[topic] = frame;
  if (watching_[topic] == 0) return;
  for (const auto& viewer : viewers_) {
    if (!viewer->topics.test(topic)) continue;
    ++statistics_.deliveries;
    viewer->socket->state(topic, frame);
  }
}

void Hub::state(std::size_t topic, const Json& message) { send(topic, text_frame(message)); }

void Hub::state_binary(std::size_t topic, std::string_view head, std::string_view body) {
  std::string payload;
  payload.reserve(head.size() + body.size());
  payload.append(head).append(body);
  send(topic, std::make_shared<const std::string>(protocols::web::encode_frame(Opcode::binary, payload)));
}

void Hub::state(std::size_t topic, const Json& message, const std::map<std::string, Json>& own) {
  own_[topic].clear();
  for (const auto& [session, theirs] : own) own_[topic][session] = text_frame(theirs);
  ++statistics_.frames;
  newest_[topic] = text_frame(message);
  for (const auto& viewer : viewers_) {
    if (!viewer->topics.test(topic)) continue;
    ++statistics_.deliveries;
    send_newest(*viewer, topic);
  }
}

void Hub::event(Topic topic, Json message, const std::string& owner, Json own) {
  message["seq"] = ++seq_;
  Past past{seq_, topic, text_frame(message), owner, nullptr};
  if (!owner.empty()) {
    own["seq"] = seq_;
    past.own = text_frame(own);
  }
  ++statistics_.frames;
  for (const auto& viewer : viewers_) {
    if (!viewer->topics.test(index(topic))) continue;
    ++statistics_.deliveries;
    viewer->socket->event(!owner.empty() && owner == viewer->session ? past.own : past.frame);
  }
  past_.push_back(std::move(past));
  if (past_.size() > ring) past_.pop_front();
}

void Hub::tell_laggards() {
  for (const auto& viewer : viewers_) {
    const std::uint64_t dropped = viewer->socket->take_dropped();
    if (dropped == 0) continue;
    statistics_.dropped += dropped;
    answer(*viewer, {{"type", "lagging"}, {"dropped", dropped}});
  }
}

void Hub::close_all(std::uint16_t code, std::string_view reason) {
  for (const auto& viewer : viewers_) viewer->socket->close(code, reason);
}

HubStatistics Hub::statistics() const {
  HubStatistics statistics = statistics_;
  for (const auto& viewer : viewers_) statistics.waiting_bytes += viewer->socket->waiting_bytes();
  return statistics;
}

void Hub::count(const TopicSet& topics, int change) {
  for (std::size_t topic = 0; topic < most_topics; ++topic) {
    if (topics.test(topic)) watching_[topic] += change;
    if (watching_[topic] == 0 && is_on_demand(topic))
      newest_[topic].reset();  // it would be old when it is wanted again
  }
}

}  // namespace server
