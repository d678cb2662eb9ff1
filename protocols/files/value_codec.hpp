// The robot's values as CBOR (RFC 8949) and back, bit for bit: vectors of floats and of small enumerations travel as
// byte strings, NaN keeps its bits, times are integers of nanoseconds.
#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocols/files/value_fields.hpp"

namespace files {

// A message is not what it claims to be.
struct DecodeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using nlohmann::json;

template <typename T>
concept Enumeration = std::is_enum_v<T>;

// Vectors of these go as raw little-endian bytes.
template <typename T>
concept Packed = std::floating_point<T> ||(std::is_enum_v<T> && sizeof(T) == 1);
// A struct whose fields are named in value_fields.hpp.
struct AnyVisitor {
  template <typename F>
  void operator()(const char*, F&) {}
};
template <typename T>
concept Fielded = requires(T& value, AnyVisitor& visit) {
  fields(value, visit);
};
static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

// ---- Values to JSON --------------------------------------------------------------------------------------------

template <typename T>
json raw_bytes(const T* values, std::size_t count) {
  std::vector<std::uint8_t> bytes(count * sizeof(T));
  if (count > 0) std::memcpy(bytes.data(), values, bytes.size());
  return json::binary(std::move(bytes));
}

template <std::floating_point T>
json encode(const T& value) {
  if (std::isnan(value)) return raw_bytes(&value, 1);
  return static_cast<double>(value);
}
template <std::integral T>
json encode(const T& value) {
  return value;
}
inline json encode(const std::string& value) { return value; }
template <Enumeration E>
json encode(const E& value) {
  return static_cast<unsigned>(value);
}
inline json encode(const robot::Time& time) { return time.time_since_epoch().count(); }
inline json encode(const robot::Seconds& seconds) { return encode(seconds.count()); }
inline json encode(const robot::Text& text) { return text; }

template <typename T>
json encode(const std::optional<T>& value);
template <typename T>
json encode(const std::vector<T>& values);
template <typename... Ts>
json encode(const std::variant<Ts...>& value);

template <Fielded T>
json encode(const T& value) {
  json object = json::object();
  auto visit = [&](const char* name, const auto& field) { object[name] = encode(field); };
  fields(value, visit);
  return object;
}
template <typename T>
json encode(const std::optional<T>& value) {
  return value ? encode(*value) : json(nullptr);
}
template <typename T>
json encode(const std::vector<T>& values) {
  if constexpr (Packed<T>) {
    return raw_bytes(values.data(), values.size());
  } else {
    json array = json::array();
    for (const auto& value : values) array.push_back(encode(value));
    return array;
  }
}
template <typename... Ts>
json encode(const std::variant<Ts...>& value) {
  return json::array({value.index(), std::visit([](const auto& each) { return encode(each); }, value)});
}

// ---- JSON to values --------------------------------------------------------------------------------------------

// Each throws DecodeError, or nlohmann's exceptions, when the JSON is of another shape.
template <typename T>
void decode(const json& in, std::vector<T>& values);
template <typename T>
void decode(const json& in, std::optional<T>& value);
template <typename... Ts>
void decode(const json& in, std::variant<Ts...>& value);

template <typename T>
std::vector<T> from_raw_bytes(const json& in) {
  if (!in.is_binary() || in.get_binary().size() % sizeof(T) != 0) throw DecodeError("a byte string has another size");
  const auto& bytes = in.get_binary();
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

template <std::floating_point T>
void decode(const json& in, T& value) {
  if (in.is_binary()) {
    const auto one = from_raw_bytes<T>(in);
    if (one.size() != 1) throw DecodeError("a number has another size");
    value = one[0];
  } else {
    if (!in.is_number()) throw DecodeError("a number is missing");
    value = in.get<T>();
  }
}
template <std::integral T>
void decode(const json& in, T& value) {
  if constexpr (std::same_as<T, bool>) {
    value = in.get<bool>();
  } else {
    if (!in.is_number_integer()) throw DecodeError("an integer is missing");
    const bool fits =
        in.is_number_unsigned() ? std::in_range<T>(in.get<std::uint64_t>()) : std::in_range<T>(in.get<std::int64_t>());
    if (!fits) throw DecodeError("an integer is out of range");
    value = in.get<T>();
  }
}
inline void decode(const json& in, std::string& value) { value = in.get<std::string>(); }
template <Enumeration E>
void decode(const json& in, E& value) {
  unsigned number = 0;
  decode(in, number);
  if (number > static_cast<unsigned>(last_of<E>)) throw DecodeError("a value of an enumeration is not known");
  value = static_cast<E>(number);
}
inline void decode(const json& in, robot::Time& time) {
  std::int64_t ns = 0;
  decode(in, ns);
  time = robot::Time(robot::RobotClock::duration(ns));
}
inline void decode(const json& in, robot::Seconds& seconds) {
  double value = 0.0;
  decode(in, value);
  seconds = robot::Seconds(value);
}
inline void decode(const json& in, robot::Text& text) { text = in.get<robot::Text>(); }

template <Fielded T>
void decode(const json& in, T& value) {
  auto visit = [&](const char* name, auto& field) { decode(in.at(name), field); };
  fields(value, visit);
}
template <typename T>
void decode(const json& in, std::optional<T>& value) {
  if (in.is_null()) return value.reset();
  decode(in, value.emplace());
}
template <typename T>
void decode(const json& in, std::vector<T>& values) {
  if constexpr (Packed<T>) {
    if constexpr (std::is_enum_v<T>) {
      const auto bytes = from_raw_bytes<std::uint8_t>(in);
      for (const auto byte : bytes) {
        if (byte > static_cast<std::uint8_t>(last_of<T>)) throw DecodeError("a value of an enumeration is not known");
      }
    }
    values = from_raw_bytes<T>(in);
  } else {
    if (!in.is_array()) throw DecodeError("a list is missing");
    values.clear();
    for (const auto& each : in) decode(each, values.emplace_back());
  }
}
template <typename... Ts>
void decode(const json& in, std::variant<Ts...>& value) {
  if (!in.is_array() || in.size() != 2) throw DecodeError("a choice is missing");
  std::size_t index = 0;
  decode(in[0], index);
  const auto take = [&]<std::size_t... I>(std::index_sequence<I...>) {
    return ((index == I && (decode(in[1], value.template emplace<I>()), true)) || ...);
  };
  if (!take(std::index_sequence_for<Ts...>{})) throw DecodeError("a choice is not known");
}

// ---- Bytes -----------------------------------------------------------------------------------------------------

template <typename T>
std::string to_cbor(const T& value) {
  std::string bytes;
  json::to_cbor(encode(value), bytes);
  return bytes;
}

// Parses hostile bytes: refuses nesting deeper than any value of ours before it can exhaust the stack.
// Throws DecodeError.
json parse_cbor(std::string_view bytes);

template <typename T>
T from_cbor(std::string_view bytes) {
  T value;
  try {
    decode(parse_cbor(bytes), value);
  } catch (const json::exception& error) {
    throw DecodeError(error.what());
  }
  return value;
}

}  // namespace files
