// UTF-8 one code point at a time, and which of them may stand in a name.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace protocols::web {

// Takes the first code point off a non-empty text; none when it is malformed (RFC 3629), and then the text is
// unchanged.
std::optional<char32_t> next_code_point(std::string_view& text);

// False for what cannot be seen or changes how its neighbours are shown: control characters, separators of lines, zero
// width characters, direction overrides, private use, non-characters.
bool is_printable(char32_t point);

}  // namespace protocols::web
