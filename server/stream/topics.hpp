// The topics of /ws. Fixed ones are numbered here; after them comes one for each camera.
#pragma once

#include <bitset>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace server {

enum class Topic : std::size_t {
  pose,
  status,
  path,
  people,
  queue,
  viewers,
  health,
  belief,
  velocity_space,
  scan_front,
  scan_rear,  // newest wins
  speech,
  note,
  visit,
  request,  // events
};
inline constexpr std::size_t fixed_topics = 15;
inline constexpr std::size_t most_topics = 64;

using TopicSet = std::bitset<most_topics>;

constexpr std::size_t index(Topic topic) { return static_cast<std::size_t>(topic); }
constexpr std::size_t camera_topic(std::size_t camera) { return fixed_topics + camera; }
constexpr bool is_event(std::size_t topic) { return topic >= index(Topic::speech) && topic < fixed_topics; }

// Encoded only while somebody watches: scans, the belief, the velocity space, cameras.
constexpr bool is_on_demand(std::size_t topic) {
  return (topic >= index(Topic::belief) && topic <= index(Topic::scan_rear)) || topic >= fixed_topics;
}

// What a viewer gets who has asked for nothing yet.
TopicSet default_topics();

// The topics of a name as clients say it ("scan" means both lasers, "camera:hall" one camera); none: no such topic.
std::optional<TopicSet> topics_named(std::string_view name, const std::vector<std::string>& cameras);

}  // namespace server
