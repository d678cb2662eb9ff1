// What people send, checked field by field. Each decoder takes the raw body and gives the value, or a Problem that says
// which field to mend. Unknown fields are refused, so that a misspelt one is not silently ignored.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocols/web/problem.hpp"
#include "robot/inputs.hpp"

namespace protocols::web {

// A person's name: trimmed, 1 to 40 characters, valid UTF-8, nothing invisible (control, direction override, zero
// width).
Decoded<std::string> decode_name(std::string_view text);

struct QueueBody {
  robot::Target target;
  std::optional<std::string> name;
};
Decoded<QueueBody> decode_queue(std::string_view body);

struct TourBody {
  std::string tour;
  std::optional<std::string> name;
};
Decoded<TourBody> decode_tour(std::string_view body);

Decoded<robot::TourAnswer> decode_tour_answer(std::string_view body);
Decoded<robot::Mode> decode_settings(std::string_view body);

// A pose, or none: let the robot look for itself over the whole map.
struct PoseBody {
  std::optional<robot::Pose> pose;
};
Decoded<PoseBody> decode_pose(std::string_view body);

// Exactly one of the two.
struct SessionBody {
  std::optional<std::string> name;
  std::optional<std::string> password;
};
Decoded<SessionBody> decode_session(std::string_view body);

// Text messages of /ws.
struct Subscribe {
  std::vector<std::string> topics;
};
struct Resume {
  std::string epoch;
  std::uint64_t last_seq = 0;
};
struct Ping {
  std::uint64_t id = 0;
};
using ClientMessage = std::variant<Subscribe, Resume, Ping>;
Decoded<ClientMessage> decode_client_message(std::string_view text);

// Well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates, at most U+10FFFF).
bool is_utf8(std::string_view text);

}  // namespace protocols::web
