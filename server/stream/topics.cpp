#include "server/stream/topics.hpp"

#include <array>
#include <utility>

namespace server {
namespace {

constexpr std::array<std::pair<std::string_view, Topic>, 13> names{{
    {"pose", Topic::pose},
    {"status", Topic::status},
    {"path", Topic::path},
    {"people", Topic::people},
    {"queue", Topic::queue},
    {"viewers", Topic::viewers},
    {"health", Topic::health},
    {"belief", Topic::belief},
    {"velocity_space", Topic::velocity_space},
    {"speech", Topic::speech},
    {"note", Topic::note},
    {"visit", Topic::visit},
    {"request", Topic::request},
}};

}  // namespace

TopicSet default_topics() {
  TopicSet set;
  for (const Topic topic :
       {Topic::pose, Topic::status, Topic::path, Topic::people, Topic::queue, Topic::viewers, Topic::speech}) {
    set.set(index(topic));
  }
  return set;
}

std::optional<TopicSet> topics_named(std::string_view name, const std::vector<std::string>& cameras) {
  TopicSet set;
  if (name == "hello") return set;  // everybody gets it
  if (name == "scan") return set.set(index(Topic::scan_front)).set(index(Topic::scan_rear));
  for (const auto& [known, topic] : names) {
    if (name == known) return set.set(index(topic));
  }
  constexpr std::string_view camera = "camera:";
  if (!name.starts_with(camera)) return std::nullopt;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (name.substr(camera.size()) == cameras[i]) return set.set(camera_topic(i));
  }
  return std::nullopt;
}

}  // namespace server
