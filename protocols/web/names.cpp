#include "protocols/web/names.hpp"

#include <array>

namespace protocols::web {
namespace {

template <typename Enum, std::size_t N>
const char* pick(const std::array<const char*, N>& names, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? names[index] : "unknown";
}

template <typename Enum, std::size_t N>
std::optional<Enum> find(const std::array<const char*, N>& names, std::string_view name) {
  for (std::size_t i = 0; i < N; ++i) {
    if (name == names[i]) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

// In the order of the enumerators; names_test.cpp checks each against its enumerator.
constexpr std::array activities{"starting", "localizing", "idle",   "homing",  "driving",
                                "waiting",  "explaining", "asking", "stopped", "faulted"};
constexpr std::array whys{"none",        "requested",      "tour",         "nothing_to_do", "people_in_the_way",
                          "way_blocked", "crowded_slow",   "pressed_stop", "laser_silent",  "base_silent",
                          "bumped",      "emergency_stop", "lost",         "hazard_near",   "motors_off",
                          "recording"};
constexpr std::array modes{"open", "web_only", "staff"};
constexpr std::array channels{"web", "kiosk", "console", "program"};
constexpr std::array states{"pending", "active", "fulfilled", "cancelled", "failed"};
constexpr std::array cues{"narration", "greeting", "make_way", "horn", "arrived", "farewell"};
constexpr std::array severities{"info", "warning", "incident"};
constexpr std::array hazards{"glass", "low_obstacle", "staircase", "escalator", "keep_out"};

}  // namespace

const char* name_of(robot::Activity activity) { return pick(activities, activity); }
const char* name_of(robot::Why why) { return pick(whys, why); }
const char* name_of(robot::Mode mode) { return pick(modes, mode); }
const char* name_of(robot::Channel channel) { return pick(channels, channel); }
const char* name_of(robot::RequestState state) { return pick(states, state); }
const char* name_of(robot::Cue cue) { return pick(cues, cue); }
const char* name_of(robot::Severity severity) { return pick(severities, severity); }
const char* name_of(robot::HazardKind kind) { return pick(hazards, kind); }

std::optional<robot::Mode> mode_named(std::string_view name) { return find<robot::Mode>(modes, name); }
std::optional<robot::Channel> channel_named(std::string_view name) { return find<robot::Channel>(channels, name); }
std::optional<robot::RequestState> request_state_named(std::string_view name) {
  return find<robot::RequestState>(states, name);
}

}  // namespace protocols::web
