#include "protocols/web/decode.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "protocols/web/names.hpp"
#include "protocols/web/utf8.hpp"

namespace protocols::web {
namespace {

// Thrown inside this file only, to leave a decoder at the first wrong field.
struct Wrong {
  Problem problem;
};

[[noreturn]] void wrong(std::string code, std::string detail, std::string field = "", int status = 422) {
  throw Wrong{{status, std::move(code), std::move(detail), std::move(field)}};
}

constexpr std::size_t max_id = 64;  // characters of an exhibit's, tour's or topic's id

// Runs a decoder and turns what it throws into its Problem.
template <typename T, typename Decoder>
Decoded<T> guarded(std::string_view body, std::initializer_list<const char*> fields, Decoder decoder) {
  try {
    const Json json = Json::parse(body, nullptr, false);
    if (json.is_discarded())
      wrong("bad_json", "The body is not well-formed JSON (or a number in it is too large).", "", 400);
    if (!json.is_object()) wrong("not_an_object", "The body must be a JSON object.");
    for (const auto& [key, value] : json.items()) {
      if (std::find(fields.begin(), fields.end(), key) == fields.end()) {
        std::string known;
        for (const char* field : fields) known += (known.empty() ? "" : ", ") + std::string(field);
        wrong("unknown_field", "Unknown field; known are: " + known + ".", key.substr(0, max_id));
      }
    }
    return decoder(json);
  } catch (const Wrong& error) {
    return error.problem;
  }
}

bool has(const Json& json, const char* field) {
  const auto it = json.find(field);
  return it != json.end() && !it->is_null();
}

std::string text(const Json& json, const char* field, std::size_t longest = max_id) {
  if (!has(json, field)) wrong("missing_field", std::string("The field '") + field + "' is missing.", field);
  const Json& value = json.at(field);
  if (!value.is_string()) wrong("wrong_type", std::string("'") + field + "' must be a string.", field);
  const auto& words = value.get_ref<const std::string&>();
  if (words.empty() || words.size() > longest) {
    wrong("bad_length", std::string("'") + field + "' must have 1 to " + std::to_string(longest) + " bytes.", field);
  }
  return words;
}

double finite(const Json& json, const char* field) {
  if (!has(json, field)) wrong("missing_field", std::string("The field '") + field + "' is missing.", field);
  if (!json.at(field).is_number()) wrong("wrong_type", std::string("'") + field + "' must be a number.", field);
  const double value = json.at(field).get<double>();
  if (!std::isfinite(value)) wrong("not_finite", std::string("'") + field + "' must be a finite number.", field);
  return value;
}

// A whole number that is not negative and that JavaScript can hold exactly.
std::uint64_t count(const Json& json, const char* field) {
  const double value = finite(json, field);
  if (value < 0.0 || value > 9007199254740991.0 || value != std::floor(value)) {
    wrong("bad_number", std::string("'") + field + "' must be a whole number, not negative.", field);
  }
  return static_cast<std::uint64_t>(value);
}

std::optional<std::string> optional_name(const Json& json) {
  if (!has(json, "name")) return std::nullopt;
  if (!json.at("name").is_string()) wrong("wrong_type", "'name' must be a string.", "name");
  auto name = decode_name(json.at("name").get_ref<const std::string&>());
  if (auto* problem = std::get_if<Problem>(&name)) throw Wrong{*problem};
  return std::get<std::string>(name);
}

robot::Target target_of(const Json& json) {
  const bool exhibit = has(json, "exhibit"), point = has(json, "x") || has(json, "y");
  if (exhibit && point) wrong("ambiguous_target", "Give either 'exhibit', or 'x' and 'y', not both.", "exhibit");
  if (!exhibit && !point)
    wrong("missing_field", "Give 'exhibit', or 'x' and 'y', of where the robot should go.", "exhibit");
  if (point) {
    if (has(json, "viewpoint")) wrong("ambiguous_target", "'viewpoint' goes with 'exhibit' only.", "viewpoint");
    robot::PointTarget place{{finite(json, "x"), finite(json, "y")}, std::nullopt};
    if (has(json, "theta")) place.theta = robot::wrap_angle(finite(json, "theta"));
    return place;
  }
  if (has(json, "theta")) wrong("ambiguous_target", "'theta' goes with 'x' and 'y' only.", "theta");
  robot::ExhibitTarget target{text(json, "exhibit"), std::nullopt};
  if (has(json, "viewpoint"))
    target.viewpoint = static_cast<int>(std::min<std::uint64_t>(count(json, "viewpoint"), 1'000'000));
  return target;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    if (!next_code_point(text)) return false;
  }
  return true;
}

Decoded<std::string> decode_name(std::string_view text) {
  constexpr int longest = 40;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  int characters = 0;
  for (std::string_view rest = text; !rest.empty() && characters <= longest; ++characters) {
    const auto point = next_code_point(rest);
    if (!point) return Problem{422, "bad_name", "The name is not valid UTF-8.", "name"};
    if (!is_printable(*point)) {
      return Problem{422, "bad_name", "The name holds a control or invisible character.", "name"};
    }
  }
  if (characters < 1 || characters > longest) return Problem{422, "bad_name", "A name has 1 to 40 characters.", "name"};
  return std::string(text);
}

Decoded<QueueBody> decode_queue(std::string_view body) {
  return guarded<QueueBody>(body, {"exhibit", "viewpoint", "x", "y", "theta", "name"}, [](const Json& json) {
    return QueueBody{target_of(json), optional_name(json)};
  });
}

Decoded<TourBody> decode_tour(std::string_view body) {
  return guarded<TourBody>(body, {"tour", "name"}, [](const Json& json) {
    return TourBody{text(json, "tour"), optional_name(json)};
  });
}

Decoded<robot::TourAnswer> decode_tour_answer(std::string_view body) {
  return guarded<robot::TourAnswer>(body, {"answer"}, [](const Json& json) {
    const std::string answer = text(json, "answer");
    if (answer == "more") return robot::TourAnswer::more;
    if (answer == "move_on") return robot::TourAnswer::move_on;
    wrong("bad_answer", "'answer' must be \"more\" or \"move_on\".", "answer");
  });
}

Decoded<robot::Mode> decode_settings(std::string_view body) {
  return guarded<robot::Mode>(body, {"mode"}, [](const Json& json) {
    const auto mode = mode_named(text(json, "mode"));
    if (!mode) wrong("bad_mode", "'mode' must be \"open\", \"web_only\" or \"staff\".", "mode");
    return *mode;
  });
}

Decoded<PoseBody> decode_pose(std::string_view body) {
  return guarded<PoseBody>(body, {"x", "y", "theta", "global"}, [](const Json& json) {
    if (has(json, "global")) {
      if (json.at("global") != true) wrong("wrong_type", "'global' can only be true.", "global");
      if (json.size() != 1) wrong("ambiguous_pose", "'global' stands alone, without 'x', 'y' and 'theta'.", "global");
      return PoseBody{};
    }
    return PoseBody{robot::Pose{finite(json, "x"), finite(json, "y"), robot::wrap_angle(finite(json, "theta"))}};
  });
}

Decoded<SessionBody> decode_session(std::string_view body) {
  return guarded<SessionBody>(body, {"name", "password"}, [](const Json& json) {
    if (has(json, "password") == has(json, "name")) wrong("missing_field", "Give either 'name' or 'password'.", "name");
    SessionBody session;
    if (has(json, "password")) session.password = text(json, "password", 256);
    session.name = optional_name(json);
    return session;
  });
}

Decoded<ClientMessage> decode_client_message(std::string_view body) {
  constexpr std::size_t most_topics = 64;
  return guarded<ClientMessage>(body, {"type", "topics", "epoch", "last_seq", "id"},
                                [](const Json& json) -> ClientMessage {
                                  const std::string type = text(json, "type");
                                  if (type == "ping") return Ping{count(json, "id")};
                                  if (type == "resume") return Resume{text(json, "epoch"), count(json, "last_seq")};
                                  if (type != "subscribe")
                                    wrong("unknown_type", "'type' must be subscribe, resume or ping.", "type");
                                  if (!has(json, "topics") || !json.at("topics").is_array())
                                    wrong("wrong_type", "'topics' must be a list.", "topics");
                                  Subscribe subscribe;
                                  for (const Json& topic : json.at("topics")) {
                                    if (!topic.is_string() || topic.get_ref<const std::string&>().size() > max_id) {
                                      wrong("wrong_type", "Each topic must be a short string.", "topics");
                                    }
                                    if (subscribe.topics.size() >= most_topics)
                                      wrong("too_many", "At most 64 topics.", "topics");
                                    subscribe.topics.push_back(topic.get<std::string>());
                                  }
                                  return subscribe;
                                });
}

}  // namespace protocols::web
