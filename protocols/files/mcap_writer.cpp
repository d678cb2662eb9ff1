#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <ostream>

#include "protocols/files/mcap.hpp"
#include "protocols/files/mcap_format.hpp"
#include "protocols/files/wire.hpp"

namespace files {
namespace {

constexpr std::size_t chunk_bytes = 256 * 1024;
constexpr std::uint64_t chunk_ns = 1'000'000'000;
constexpr int compression_level = 3;
constexpr std::string_view compression = "zstd";

std::uint32_t crc_of(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
}

std::string record(std::uint8_t opcode, std::string_view content) {
  std::string bytes(1, static_cast<char>(opcode));
  put_int(bytes, static_cast<std::uint64_t>(content.size()));
  bytes += content;
  return bytes;
}

std::string pairs(const std::map<std::string, std::string>& values) {
  std::string inner;
  for (const auto& [key, value] : values) put_string(inner, key), put_string(inner, value);
  std::string bytes;
  put_string(bytes, inner);
  return bytes;
}

std::string counts(const std::map<std::uint16_t, std::uint64_t>& values) {
  std::string inner;
  for (const auto& [key, value] : values) put_int(inner, key), put_int(inner, value);
  std::string bytes;
  put_string(bytes, inner);
  return bytes;
}

std::string packed(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const auto size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), compression_level);
  out.resize(ZSTD_isError(size) ? 0 : size);  // cannot fail within the bound
  return out;
}

}  // namespace

McapWriter::McapWriter(std::ostream& out, const std::string& library) : out_(out) {
  put(mcap::magic);
  std::string content;
  put_string(content, "");
  put_string(content, library);
  put_record(mcap::header, content);
}

McapWriter::~McapWriter() { finish(); }

bool McapWriter::ok() const { return static_cast<bool>(out_); }

void McapWriter::put(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  crc_ = crc_of(crc_, bytes);
  written_ += bytes.size();
}

void McapWriter::put_record(std::uint8_t opcode, const std::string& content) { put(record(opcode, content)); }

void McapWriter::metadata(const std::string& name, const std::map<std::string, std::string>& values) {
  std::string content;
  put_string(content, name);
  content += pairs(values);
  const std::uint64_t offset = written_;
  put_record(mcap::metadata, content);
  metadata_.push_back({name, {offset, written_ - offset}});
}

std::string McapWriter::schema_record(const McapChannel& channel) const {
  std::string content;
  put_int(content, channel.id);
  put_string(content, channel.schema);
  put_string(content, "");  // the encoding of the schema's text: it has none, CBOR describes itself
  put_string(content, "");
  return record(mcap::schema, content);
}

std::string McapWriter::channel_record(const McapChannel& channel) const {
  std::string content;
  put_int(content, channel.id);
  put_int(content, channel.id);  // of its schema
  put_string(content, channel.topic);
  put_string(content, channel.encoding);
  content += pairs({});
  return record(mcap::channel, content);
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& encoding,
                                      const std::string& schema) {
  channels_.push_back({static_cast<std::uint16_t>(channels_.size() + 1), topic, encoding, schema});
  put(schema_record(channels_.back()));
  put(channel_record(channels_.back()));
  return channels_.back().id;
}

void McapWriter::write(std::uint16_t channel, std::uint64_t time_ns, std::string_view data) {
  if (pending_.empty()) {
    // Schemas and channels stand in each chunk too, so that one can be read alone.
    for (const auto& each : channels_) pending_ += schema_record(each) + channel_record(each);
    pending_start_ = pending_end_ = time_ns;
  }
  pending_index_[channel].push_back({time_ns, pending_.size()});
  std::string content;
  content.reserve(data.size() + 22);
  put_int(content, channel);
  put_int(content, static_cast<std::uint32_t>(counts_[channel]++));
  put_int(content, time_ns);
  put_int(content, time_ns);
  content += data;
  pending_ += record(mcap::message, content);
  pending_start_ = std::min(pending_start_, time_ns);
  pending_end_ = std::max(pending_end_, time_ns);
  if (pending_.size() >= chunk_bytes || pending_end_ - pending_start_ >= chunk_ns) flush();
}

void McapWriter::flush() {
  if (!pending_.empty()) {
    const std::string body = packed(pending_);
    std::string content;
    put_int(content, pending_start_);
    put_int(content, pending_end_);
    put_int(content, static_cast<std::uint64_t>(pending_.size()));
    put_int(content, crc_of(0, pending_));
    put_string(content, compression);
    put_int(content, static_cast<std::uint64_t>(body.size()));
    content += body;
    Chunk chunk{pending_start_, pending_end_, written_, 0, 0, body.size(), pending_.size(), {}};
    put_record(mcap::chunk, content);
    chunk.length = written_ - chunk.offset;
    put_message_indexes(chunk);
    chunks_.push_back(std::move(chunk));
    pending_.clear();
    pending_index_.clear();
  }
  out_.flush();
}

void McapWriter::put_message_indexes(Chunk& chunk) {
  const std::uint64_t begin = written_;
  for (const auto& [channel, entries] : pending_index_) {
    chunk.index_offsets[channel] = written_;
    std::string list;
    for (const auto& [time, offset] : entries) put_int(list, time), put_int(list, offset);
    std::string content;
    put_int(content, channel);
    put_string(content, list);
    put_record(mcap::message_index, content);
  }
  chunk.index_length = written_ - begin;
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0, first = chunks_.empty() ? 0 : std::numeric_limits<std::uint64_t>::max(), last = 0;
  for (const auto& [channel, count] : counts_) messages += count;
  for (const auto& chunk : chunks_) {
    first = std::min(first, chunk.start_time);
    last = std::max(last, chunk.end_time);
  }
  std::string content;
  put_int(content, messages);
  put_int(content, static_cast<std::uint16_t>(channels_.size()));  // schemas
  put_int(content, static_cast<std::uint32_t>(channels_.size()));
  put_int(content, std::uint32_t{0});  // attachments
  put_int(content, static_cast<std::uint32_t>(metadata_.size()));
  put_int(content, static_cast<std::uint32_t>(chunks_.size()));
  put_int(content, first);
  put_int(content, last);
  content += counts(counts_);
  return record(mcap::statistics, content);
}

// The summary section, its groups by opcode, and after it where each group begins.
std::string McapWriter::summary() {
  std::string bytes, offsets;
  const auto group = [&](std::uint8_t opcode, const std::string& records) {
    if (records.empty()) return;
    std::string content(1, static_cast<char>(opcode));
    put_int(content, written_ + bytes.size());
    put_int(content, static_cast<std::uint64_t>(records.size()));
    offsets += record(mcap::summary_offset, content);
    bytes += records;
  };
  std::string schemas, channels, chunks, metadata;
  for (const auto& channel : channels_) schemas += schema_record(channel), channels += channel_record(channel);
  for (const auto& chunk : chunks_) {
    std::string content;
    for (const auto value : {chunk.start_time, chunk.end_time, chunk.offset, chunk.length}) put_int(content, value);
    content += counts(chunk.index_offsets);
    put_int(content, chunk.index_length);
    put_string(content, compression);
    put_int(content, chunk.packed_size);
    put_int(content, chunk.size);
    chunks += record(mcap::chunk_index, content);
  }
  for (const auto& [name, place] : metadata_) {
    std::string content;
    put_int(content, place[0]);
    put_int(content, place[1]);
    put_string(content, name);
    metadata += record(mcap::metadata_index, content);
  }
  group(mcap::schema, schemas);
  group(mcap::channel, channels);
  group(mcap::statistics, statistics());
  group(mcap::chunk_index, chunks);
  group(mcap::metadata_index, metadata);
  const std::uint64_t start = written_, offset_start = written_ + bytes.size();
  std::string footer(1, static_cast<char>(mcap::footer));
  put_int(footer, std::uint64_t{20});
  put_int(footer, start);
  put_int(footer, offset_start);
  bytes += offsets + footer;
  put_int(bytes, crc_of(0, bytes));
  return bytes;
}

void McapWriter::finish() {
  if (finished_) return;
  finished_ = true;
  flush();
  std::string end;
  put_int(end, crc_);
  put_record(mcap::data_end, end);
  put(summary());
  put(mcap::magic);
  out_.flush();
}

}  // namespace files
