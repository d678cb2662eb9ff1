// MCAP files (https://mcap.dev/spec): messages of several channels with times, in compressed chunks, with an index at
// the end so that other programs can seek. What a killed process leaves behind is read as far as whole chunks go.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace files {

struct McapChannel {
  std::uint16_t id = 0;  // from 1
  std::string topic;
  std::string encoding;  // of its messages: "cbor", "json", ...
  std::string schema;    // name of what a message holds
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t time = 0;  // ns
  std::string data;
};

class McapWriter {
 public:
  // Writes the head at once. The stream must be binary and outlive the writer.
  McapWriter(std::ostream& out, const std::string& library);
  ~McapWriter();  // finishes, ignoring failures
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // A record of names and values about the whole file. Before the first message.
  void metadata(const std::string& name, const std::map<std::string, std::string>& values);
  // Returns the channel's id. Before the first message.
  std::uint16_t add_channel(const std::string& topic, const std::string& encoding, const std::string& schema);

  // Messages are kept until they make up a chunk: 256 KiB, or a second from the chunk's first message.
  void write(std::uint16_t channel, std::uint64_t time_ns, std::string_view data);
  // Writes what is kept, and asks the stream to hand it on.
  void flush();
  // The rest, the index and the end; nothing may follow.
  void finish();
  // False once the stream has failed, for example on a full disk.
  bool ok() const;

 private:
  struct Chunk {
    std::uint64_t start_time, end_time, offset, length, index_length, packed_size, size;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };
  void put(std::string_view bytes);
  void put_record(std::uint8_t opcode, const std::string& content);
  void put_message_indexes(Chunk& chunk);
  std::string statistics() const;
  std::string summary();
  std::string schema_record(const McapChannel& channel) const;
  std::string channel_record(const McapChannel& channel) const;

  std::ostream& out_;
  std::uint64_t written_ = 0;
  std::uint32_t crc_ = 0;  // of all that was written
  bool finished_ = false;
  std::vector<McapChannel> channels_;
  std::vector<std::pair<std::string, std::array<std::uint64_t, 2>>> metadata_;  // name, offset and length
  std::string pending_;  // records of the chunk that is being filled
  std::uint64_t pending_start_ = 0, pending_end_ = 0;
  std::map<std::uint16_t, std::vector<std::array<std::uint64_t, 2>>> pending_index_;  // time and offset in the chunk
  std::map<std::uint16_t, std::uint64_t> counts_;                                     // messages by channel
  std::vector<Chunk> chunks_;
};

// Reads a file from front to end. Every length is checked against what is there; a damaged chunk is left out and
// counted.
class McapReader {
 public:
  // Throws FileError when the stream does not begin like an MCAP file.
  McapReader(std::istream& in, std::string name);

  // The next message, or nothing at the end.
  std::optional<McapMessage> next();
  // Channels and metadata as far as they have been read: all of them once next() was called.
  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  const std::map<std::string, std::map<std::string, std::string>>& metadata() const { return metadata_; }
  // True when the file ended without its proper end: its writer was killed, or it was cut.
  bool cut() const { return cut_; }
  int damaged_chunks() const { return damaged_; }

 private:
  bool read_record();  // false at the end
  void handle(std::uint8_t opcode, std::string_view content, bool in_chunk);
  void unpack_chunk(std::string_view content);

  std::istream& in_;
  std::string name_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::map<std::string, std::map<std::string, std::string>> metadata_;
  std::vector<McapMessage> ready_;  // of the chunk that was read last, the next one at the back
  bool ended_ = false;
  bool cut_ = false;
  int damaged_ = 0;
};

}  // namespace files
