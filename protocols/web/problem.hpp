// An error as RFC 9457 tells it: a stable code for programs, a sentence for people, and the field to mend.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "robot/outputs.hpp"

namespace protocols::web {

// Keys keep their order on the wire, so that people find them where the documents put them.
using Json = nlohmann::ordered_json;

struct Problem {
  int status = 500;    // HTTP status
  std::string code;    // stable, snake_case
  std::string detail;  // what is wrong and what to mend, in English
  std::string field;   // JSON pointer-like name of the offending field, or empty
};

// What a decoder gives: the value, or what to answer instead.
template <typename T>
using Decoded = std::variant<T, Problem>;

// `{type, title, status, detail, code, field?}`.
Json encode(const Problem& problem);

// The standard reason phrase of an HTTP status that Docent uses.
const char* status_title(int status);

// What the robot's refusal means to the one who asked. Must not be called with Refusal::none.
Problem problem_of(robot::Refusal refusal);

}  // namespace protocols::web
