#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <istream>

#include "protocols/files/mcap.hpp"
#include "protocols/files/mcap_format.hpp"
#include "protocols/files/problem.hpp"
#include "protocols/files/wire.hpp"

namespace files {
namespace {

constexpr std::uint64_t max_record = 64u << 20;
constexpr std::uint64_t max_chunk = 64u << 20;

std::optional<std::map<std::string, std::string>> take_pairs(WireReader& in) {
  std::string_view bytes;
  if (!in.take_string(bytes)) return std::nullopt;
  std::map<std::string, std::string> values;
  WireReader inner(bytes);
  while (inner.left() > 0) {
    std::string_view key, value;
    if (!inner.take_string(key) || !inner.take_string(value)) return std::nullopt;
    values[std::string(key)] = value;
  }
  return values;
}

// Reads up to count bytes, growing as they come, so that a length that lies costs no memory.
std::string read_up_to(std::istream& in, std::uint64_t count) {
  std::string bytes;
  while (bytes.size() < count && in) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(count - bytes.size(), 1u << 20));
    const auto before = bytes.size();
    bytes.resize(before + step);
    in.read(bytes.data() + before, static_cast<std::streamsize>(step));
    bytes.resize(before + static_cast<std::size_t>(in.gcount()));
  }
  return bytes;
}

}  // namespace

McapReader::McapReader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {
  if (read_up_to(in_, mcap::magic.size()) != mcap::magic) {
    throw FileError({name_, 0, "is not an MCAP file", "give a recording"});
  }
}

std::optional<McapMessage> McapReader::next() {
  while (ready_.empty()) {
    if (ended_ || !read_record()) return std::nullopt;
  }
  auto message = std::move(ready_.back());
  ready_.pop_back();
  return message;
}

bool McapReader::read_record() {
  const auto head = read_up_to(in_, 9);
  WireReader in(head);
  std::uint8_t opcode = 0;
  std::uint64_t length = 0;
  const bool has_head = in.take_int(opcode) && in.take_int(length) && length <= max_record;
  const auto content = has_head ? read_up_to(in_, length) : std::string();
  if (!has_head || content.size() < length) {
    ended_ = cut_ = true;
    return false;
  }
  if (opcode == mcap::data_end || opcode == mcap::footer) {
    ended_ = true;
    return false;
  }
  handle(opcode, content, false);
  return true;
}

void McapReader::handle(std::uint8_t opcode, std::string_view content, bool in_chunk) {
  WireReader in(content);
  std::uint16_t id = 0;
  std::string_view name;
  if (opcode == mcap::schema) {
    if (in.take_int(id) && id != 0 && in.take_string(name)) schemas_[id] = name;
  } else if (opcode == mcap::channel) {
    std::uint16_t schema = 0;
    std::string_view encoding;
    if (!in.take_int(id) || !in.take_int(schema) || !in.take_string(name) || !in.take_string(encoding)) return;
    channels_[id] = {id, std::string(name), std::string(encoding), schemas_[schema]};
  } else if (opcode == mcap::message) {
    McapMessage message;
    std::uint64_t published = 0;
    if (!in.take_int(message.channel) || !in.take_int(message.sequence) || !in.take_int(message.time) ||
        !in.take_int(published)) {
      return;
    }
    message.data = in.rest();
    ready_.push_back(std::move(message));
  } else if (opcode == mcap::metadata && !in_chunk) {
    if (!in.take_string(name)) return;
    if (auto values = take_pairs(in)) metadata_[std::string(name)] = std::move(*values);
  } else if (opcode == mcap::chunk && !in_chunk) {
    unpack_chunk(content);
  }
}

void McapReader::unpack_chunk(std::string_view content) {
  WireReader in(content);
  std::uint64_t start = 0, end = 0, size = 0, packed_size = 0;
  std::uint32_t crc = 0;
  std::string_view compression;
  std::optional<std::string_view> packed;
  if (in.take_int(start) && in.take_int(end) && in.take_int(size) && in.take_int(crc) && in.take_string(compression) &&
      in.take_int(packed_size)) {
    packed = in.take(packed_size);
  }
  std::string unpacked;
  bool sound = packed && size <= max_chunk;
  if (sound && compression == "zstd") {
    unpacked.resize(static_cast<std::size_t>(size));
    sound = ZSTD_decompress(unpacked.data(), unpacked.size(), packed->data(), packed->size()) == size;
  } else if (sound && compression.empty()) {
    unpacked = *packed;
    sound = unpacked.size() == size;
  } else {
    sound = false;  // a compression that is not known here
  }
  const auto found = static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(unpacked.data()), static_cast<z_size_t>(unpacked.size())));
  if (!sound || (crc != 0 && crc != found)) {
    ++damaged_;
    return;
  }
  WireReader records(unpacked);
  std::uint8_t opcode = 0;
  std::uint64_t length = 0;
  while (records.take_int(opcode) && records.take_int(length)) {
    const auto inner = records.take(length);
    if (!inner) break;
    handle(opcode, *inner, true);
  }
  std::reverse(ready_.begin(), ready_.end());
}

}  // namespace files
