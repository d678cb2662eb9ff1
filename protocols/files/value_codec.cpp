#include "protocols/files/value_codec.hpp"

namespace files {
namespace {

// Follows the parser through the bytes and stops it when they nest too deep.
struct DepthGuard : nlohmann::json_sax<json> {
  static constexpr int deepest = 16;
  int depth = 0;

  bool enter() { return ++depth <= deepest; }
  bool leave() { return --depth, true; }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool key(string_t&) override { return true; }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }
};

}  // namespace

json parse_cbor(std::string_view bytes) {
  DepthGuard guard;
  if (!json::sax_parse(bytes, &guard, json::input_format_t::cbor)) throw DecodeError("is not CBOR");
  json value = json::from_cbor(bytes, true, false);
  if (value.is_discarded()) throw DecodeError("is not CBOR");
  return value;
}

}  // namespace files
