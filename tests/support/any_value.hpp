// Arbitrary values of the robot's contract for property tests, made by the same list of fields that the codec uses:
// every field gets a random value, floats include NaN with odd bits, infinities and negative zero.
#pragma once

#include <rapidcheck.h>

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "protocols/files/value_codec.hpp"
#include "robot/geometry/random.hpp"

namespace testing_support {

class AnyValue {
 public:
  explicit AnyValue(std::uint64_t seed) : random_(seed) {}

  void fill(double& value) { value = real<double, std::uint64_t>(random_()); }
  void fill(float& value) { value = real<float, std::uint32_t>(static_cast<std::uint32_t>(random_())); }
  void fill(bool& value) { value = random_.chance(0.5); }
  template <std::integral T>
  void fill(T& value) {
    value = static_cast<T>(random_() >> random_.index(64));
  }
  template <files::Enumeration E>
  void fill(E& value) {
    value = static_cast<E>(random_.index(static_cast<std::uint64_t>(files::last_of<E>) + 1));
  }
  void fill(std::string& value) {
    value.clear();
    for (auto n = random_.index(12); n > 0; --n) value += static_cast<char>(random_.index(256));
  }
  void fill(robot::Time& value) {
    value = robot::Time(robot::RobotClock::duration(static_cast<std::int64_t>(random_() >> (1 + random_.index(40)))));
  }
  void fill(robot::Seconds& value) {
    double seconds = 0.0;
    fill(seconds);
    value = robot::Seconds(seconds);
  }
  void fill(robot::Text& value) {
    value.clear();
    for (auto n = random_.index(3); n > 0; --n) {
      std::string key, text;
      fill(key), fill(text);
      value[key] = text;
    }
  }
  template <typename T>
  void fill(std::optional<T>& value) {
    value.reset();
    if (random_.chance(0.5)) fill(value.emplace());
  }
  template <typename T>
  void fill(std::vector<T>& values) {
    values.resize(random_.index(6));
    for (auto& value : values) fill(value);
  }
  template <typename... Ts>
  void fill(std::variant<Ts...>& value) {
    fill_choice(value, random_.index(sizeof...(Ts)), std::index_sequence_for<Ts...>{});
  }
  template <files::Fielded T>
  void fill(T& value) {
    auto visit = [this](const char*, auto& field) { fill(field); };
    files::fields(value, visit);
  }
  // The alternative that is wanted.
  template <typename Variant, std::size_t... I>
  void fill_choice(Variant& value, std::size_t which, std::index_sequence<I...>) {
    ((which == I && (fill(value.template emplace<I>()), true)) || ...);
  }

 private:
  template <typename Real, typename Bits>
  Real real(Bits bits) {
    switch (random_.index(4)) {
      case 0:
        return std::bit_cast<Real>(bits);  // anything, NaN with odd bits too
      case 1:
        return std::bit_cast<Real>(
            static_cast<Bits>(bits | std::bit_cast<Bits>(std::numeric_limits<Real>::infinity())));
      case 2:
        return static_cast<Real>(-0.0);
      default:
        return static_cast<Real>(random_.uniform(-100.0, 100.0));
    }
  }
  robot::Random random_;
};

// Every bit of a value, one field after the other, as text: what two values must share to be the same.
class Bits {
 public:
  template <typename T>
  static std::string of(const T& value) {
    Bits bits;
    bits.add(value);
    return bits.text_;
  }

 private:
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(const T& value) { text_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void add(const std::string& value) { add(value.size()), text_ += value; }
  void add(const robot::Time& value) { add(value.time_since_epoch().count()); }
  void add(const robot::Seconds& value) { add(value.count()); }
  void add(const robot::Text& value) {
    for (const auto& [key, text] : value) add(key), add(text);
  }
  template <typename T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(values.size());
    for (const auto& value : values) add(value);
  }
  template <typename... Ts>
  void add(const std::variant<Ts...>& value) {
    add(value.index());
    std::visit([this](const auto& each) { add(each); }, value);
  }
  template <files::Fielded T>
  void add(const T& value) {
    auto visit = [this](const char*, const auto& field) { add(field); };
    files::fields(value, visit);
  }
  std::string text_;
};

}  // namespace testing_support
