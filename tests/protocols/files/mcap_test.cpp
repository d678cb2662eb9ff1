#include "protocols/files/mcap.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>
#include <zlib.h>

#include <sstream>

#include "protocols/files/mcap_format.hpp"
#include "protocols/files/problem.hpp"
#include "protocols/files/wire.hpp"
#include "tests/support/hostile_bytes.hpp"

namespace files {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::SizeIs;

constexpr std::uint64_t second = 1'000'000'000;

std::string written(int messages) {
  std::ostringstream out;
  McapWriter writer(out, "test");
  writer.metadata("about", {{"site", "hall"}});
  const auto a = writer.add_channel("/a", "cbor", "A");
  const auto b = writer.add_channel("/b", "json", "B");
  for (int i = 0; i < messages; ++i) {
    writer.write(i % 3 == 0 ? b : a, static_cast<std::uint64_t>(i) * second / 4, "message " + std::to_string(i));
  }
  writer.finish();
  return out.str();
}

std::uint32_t crc(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

// Records of a section: opcode and content.
std::vector<std::pair<int, std::string_view>> records(std::string_view bytes) {
  std::vector<std::pair<int, std::string_view>> found;
  WireReader in(bytes);
  std::uint8_t opcode = 0;
  std::uint64_t length = 0;
  while (in.take_int(opcode) && in.take_int(length)) {
    const auto content = in.take(length);
    if (!content) break;
    found.emplace_back(opcode, *content);
  }
  return found;
}

struct Layout {
  std::string_view data, summary, offsets, footer;
};

// Takes a file apart by its footer, as readers that seek do.
Layout layout_of(std::string_view file) {
  constexpr std::size_t footer_size = 9 + 20;
  EXPECT_TRUE(file.starts_with(mcap::magic));
  EXPECT_TRUE(file.ends_with(mcap::magic));
  const auto footer = file.substr(file.size() - 8 - footer_size, footer_size);
  WireReader in(footer.substr(9));
  std::uint64_t start = 0, offset_start = 0;
  EXPECT_TRUE(in.take_int(start) && in.take_int(offset_start));
  return {file.substr(8, start - 8), file.substr(start, offset_start - start),
          file.substr(offset_start, file.size() - 8 - footer_size - offset_start), footer};
}

TEST(Mcap, MessagesComeBackWithChannelsAndMetadata) {
  std::istringstream in(written(20));
  McapReader reader(in, "a.mcap");
  for (int i = 0; i < 20; ++i) {
    const auto message = reader.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->data, "message " + std::to_string(i));
    EXPECT_EQ(message->time, static_cast<std::uint64_t>(i) * second / 4);
    EXPECT_EQ(reader.channels().at(message->channel).topic, i % 3 == 0 ? "/b" : "/a");
  }
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.cut());
  EXPECT_EQ(reader.channels().at(1).schema, "A");
  EXPECT_EQ(reader.channels().at(2).encoding, "json");
  EXPECT_THAT(reader.metadata().at("about"), ElementsAre(Pair("site", "hall")));
}

TEST(Mcap, FooterPointsToASummaryWithItsChecksum) {
  const auto file = written(20);
  const auto layout = layout_of(file);
  std::uint32_t stored = 0;
  WireReader(layout.footer.substr(25)).take_int(stored);
  const std::string summed = std::string(layout.summary) + std::string(layout.offsets) +
                             std::string(layout.footer.substr(0, layout.footer.size() - 4));
  EXPECT_EQ(stored, crc(summed));
  std::vector<int> groups;
  for (const auto& [opcode, content] : records(layout.summary)) {
    if (groups.empty() || groups.back() != opcode) groups.push_back(opcode);
  }
  EXPECT_THAT(groups,
              ElementsAre(mcap::schema, mcap::channel, mcap::statistics, mcap::chunk_index, mcap::metadata_index));
}

TEST(Mcap, DataSectionEndsWithItsChecksum) {
  const auto file = written(20);
  const auto layout = layout_of(file);
  const auto [opcode, content] = records(layout.data).back();
  EXPECT_EQ(opcode, mcap::data_end);
  std::uint32_t stored = 0;
  WireReader(content).take_int(stored);
  EXPECT_EQ(stored, crc(std::string_view(file).substr(0, 8 + layout.data.size() - 9 - 4)));
}

TEST(Mcap, IndexLeadsToEveryChunkAndSummaryOffsetsToEveryGroup) {
  const auto file = written(20);
  const auto layout = layout_of(file);
  int chunks = 0;
  for (const auto& [opcode, content] : records(layout.summary)) {
    if (opcode != mcap::chunk_index) continue;
    ++chunks;
    WireReader in(content);
    std::uint64_t start = 0, end = 0, offset = 0, length = 0;
    std::string_view index_offsets;
    ASSERT_TRUE(in.take_int(start) && in.take_int(end) && in.take_int(offset) && in.take_int(length) &&
                in.take_string(index_offsets));
    EXPECT_LE(start, end);
    EXPECT_EQ(file[offset], mcap::chunk);
    EXPECT_EQ(file[offset + length], mcap::message_index) << "message indexes follow their chunk";
    WireReader pairs(index_offsets);
    std::uint16_t channel = 0;
    std::uint64_t index_offset = 0;
    while (pairs.take_int(channel) && pairs.take_int(index_offset)) EXPECT_EQ(file[index_offset], mcap::message_index);
  }
  EXPECT_EQ(chunks, 4) << "five seconds, a second each, both ends included";
  for (const auto& [opcode, content] : records(layout.offsets)) {
    EXPECT_EQ(opcode, mcap::summary_offset);
    WireReader in(content);
    std::uint8_t group = 0;
    std::uint64_t start = 0, length = 0;
    ASSERT_TRUE(in.take_int(group) && in.take_int(start) && in.take_int(length));
    for (const auto& [inner, unused] : records(std::string_view(file).substr(start, length))) EXPECT_EQ(inner, group);
  }
}

TEST(Mcap, StatisticsCount) {
  const auto file = written(20);
  for (const auto& [opcode, content] : records(layout_of(file).summary)) {
    if (opcode != mcap::statistics) continue;
    WireReader in(content);
    std::uint64_t messages = 0, first = 0, last = 0;
    std::uint16_t schemas = 0;
    std::uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
    ASSERT_TRUE(in.take_int(messages) && in.take_int(schemas) && in.take_int(channels) && in.take_int(attachments) &&
                in.take_int(metadata) && in.take_int(chunks) && in.take_int(first) && in.take_int(last));
    EXPECT_EQ(messages, 20u);
    EXPECT_EQ(schemas, 2u);
    EXPECT_EQ(channels, 2u);
    EXPECT_EQ(metadata, 1u);
    EXPECT_EQ(first, 0u);
    EXPECT_EQ(last, 19 * second / 4);
    return;
  }
  FAIL() << "no statistics";
}

TEST(Mcap, EmptyFileIsWhole) {
  std::istringstream in(written(0));
  McapReader reader(in, "a.mcap");
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.cut());
}

// Uncompressed chunks and messages outside of chunks, as other programs write them.
TEST(Mcap, ReadsPlainMessagesAndUncompressedChunks) {
  const auto record = [](int opcode, const std::string& content) {
    std::string bytes(1, static_cast<char>(opcode));
    put_int(bytes, static_cast<std::uint64_t>(content.size()));
    return bytes + content;
  };
  const auto message = [&](const std::string& data) {
    std::string content;
    put_int(content, std::uint16_t{1});
    put_int(content, std::uint32_t{0});
    put_int(content, std::uint64_t{5});
    put_int(content, std::uint64_t{5});
    return record(mcap::message, content + data);
  };
  const std::string inner = message("first") + message("second");
  std::string chunk;
  put_int(chunk, std::uint64_t{5});
  put_int(chunk, std::uint64_t{5});
  put_int(chunk, static_cast<std::uint64_t>(inner.size()));
  put_int(chunk, std::uint32_t{0});  // no checksum
  put_string(chunk, "");
  put_int(chunk, static_cast<std::uint64_t>(inner.size()));
  std::istringstream in(std::string(mcap::magic) + record(mcap::chunk, chunk + inner) + record(0x7f, "unknown") +
                        message("third"));
  McapReader reader(in, "a.mcap");
  EXPECT_EQ(reader.next()->data, "first");
  EXPECT_EQ(reader.next()->data, "second");
  EXPECT_EQ(reader.next()->data, "third");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.cut());
}

RC_GTEST_PROP(Mcap, DamagedFilesNeverHurt, ()) {
  static const auto good = written(30);
  std::istringstream in(*testing_support::damaged(good));
  try {
    McapReader reader(in, "a.mcap");
    int count = 0;
    while (reader.next()) ++count;
    RC_ASSERT(count <= 100);
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

TEST(Mcap, LengthsThatLieCostNothing) {
  std::string bytes(mcap::magic);
  bytes += '\x06';
  put_int(bytes, std::uint64_t{1} << 62);
  std::istringstream in(bytes + "x");
  McapReader reader(in, "a.mcap");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.cut());
}

}  // namespace
}  // namespace files
