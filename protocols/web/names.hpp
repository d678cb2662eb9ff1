// The words that enumerators have on the wire. They are stable: programs compare them.
#pragma once

#include <optional>
#include <string_view>

#include "robot/outputs.hpp"

namespace protocols::web {

const char* name_of(robot::Activity activity);
const char* name_of(robot::Why why);
const char* name_of(robot::Mode mode);
const char* name_of(robot::Channel channel);
const char* name_of(robot::RequestState state);
const char* name_of(robot::Cue cue);
const char* name_of(robot::Severity severity);
const char* name_of(robot::HazardKind kind);

std::optional<robot::Mode> mode_named(std::string_view name);
std::optional<robot::Channel> channel_named(std::string_view name);
std::optional<robot::RequestState> request_state_named(std::string_view name);

}  // namespace protocols::web
