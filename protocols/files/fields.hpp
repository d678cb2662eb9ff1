// Words and numbers of a text line, taken one after the other; a line that runs out or holds something else says so by
// an empty optional and never reads past its end.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace files {

class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line) {}

  // The next run of characters that are not blank; empty at the end.
  std::string_view word() {
    const auto start = rest_.find_first_not_of(blanks);
    if (start == std::string_view::npos) {
      rest_ = {};
      return {};
    }
    const auto end = rest_.find_first_of(blanks, start);
    const auto word = rest_.substr(start, end == std::string_view::npos ? end : end - start);
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end);
    return word;
  }

  // The next word as a finite number.
  std::optional<double> number() {
    const auto value = parse<double>(word());
    return value && std::isfinite(*value) ? value : std::nullopt;
  }
  std::optional<int> integer() { return parse<int>(word()); }

  // Reads into each in turn; false as soon as one is missing.
  template <typename... Doubles>
  bool numbers(Doubles&... values) {
    return (take(values) && ...);
  }
  bool skip(int words) {
    for (; words > 0; --words) {
      if (word().empty()) return false;
    }
    return true;
  }

 private:
  static constexpr std::string_view blanks = " \t\r,";

  template <typename T>
  static std::optional<T> parse(std::string_view word) {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
  }
  bool take(double& value) {
    const auto found = number();
    if (found) value = *found;
    return found.has_value();
  }

  std::string_view rest_;
};

// Calls f(line_number, line) for each line of a text, from 1; the line's end is left out.
template <typename F>
void for_each_line(std::string_view text, F f) {
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    f(number, text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
}

}  // namespace files
