// The target of a request line, taken apart and checked.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace server {

// %XX decoded once; none when an escape is cut or malformed.
std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space = false);

struct Url {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
};

// Origin form only ("/path?query"). None when it is malformed, not UTF-8, holds control characters or a backslash, or
// has
// "." or ".." as a segment, so that no handler ever sees a path that climbs.
std::optional<Url> parse_target(std::string_view target);

}  // namespace server
