#include "protocols/files/recording.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "protocols/files/problem.hpp"
#include "protocols/files/value_codec.hpp"
#include "tests/support/any_value.hpp"
#include "tests/support/hostile_bytes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace files {
namespace {

using ::testing::SizeIs;
using testing_support::AnyValue;
using testing_support::Bits;

// Alternative `which` of a variant, at random.
template <typename Variant, std::size_t... I>
Variant any_of(std::size_t which, std::uint64_t seed, std::index_sequence<I...> all) {
  Variant value;
  AnyValue(seed).fill_choice(value, which, all);
  return value;
}
template <typename Variant>
Variant any_of(std::size_t which, std::uint64_t seed) {
  return any_of<Variant>(which, seed, std::make_index_sequence<std::variant_size_v<Variant>>{});
}

RC_GTEST_PROP(ValueCodec, EveryEventComesBackBitForBit, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  for (std::size_t which = 0; which < std::variant_size_v<robot::Event>; ++which) {
    const robot::Input input{robot::from_seconds(1.5), any_of<robot::Event>(which, seed)};
    const auto back = from_cbor<robot::Input>(to_cbor(input));
    RC_ASSERT(back.event.index() == which);
    RC_ASSERT(Bits::of(back) == Bits::of(input));
  }
}

RC_GTEST_PROP(ValueCodec, EveryOutputComesBackBitForBit, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  for (std::size_t which = 0; which < std::variant_size_v<robot::Output>; ++which) {
    const auto output = any_of<robot::Output>(which, seed);
    const auto back = from_cbor<robot::Output>(to_cbor(output));
    RC_ASSERT(back.index() == which);
    RC_ASSERT(Bits::of(back) == Bits::of(output));
  }
}

TEST(ValueCodec, BitsTellNaNsApart) {
  robot::SetPose a, b;
  a.map_from_base.x = std::bit_cast<double>(0x7ff8000000000001ull);
  b.map_from_base.x = std::bit_cast<double>(0xfff8000000000002ull);
  EXPECT_NE(Bits::of(a), Bits::of(b));
  EXPECT_EQ(Bits::of(from_cbor<robot::SetPose>(to_cbor(b))), Bits::of(b));
}

RC_GTEST_PROP(ValueCodec, DamagedMessagesAreReadOrRefused, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const auto which = static_cast<std::size_t>(seed % std::variant_size_v<robot::Event>);
  const robot::Input input{robot::from_seconds(1.0), any_of<robot::Event>(which, seed)};
  try {
    from_cbor<robot::Input>(*testing_support::damaged(to_cbor(input)));
  } catch (const DecodeError& error) {
    RC_ASSERT(std::string(error.what()) != "");
  }
}

TEST(ValueCodec, DeepNestingIsRefusedBeforeItHurts) {
  const std::string nested(1'000'000, '\x81');  // a list in a list in a list ...
  EXPECT_THROW(parse_cbor(nested), DecodeError);
  EXPECT_THROW(from_cbor<robot::Input>(std::string(100'000, '\xa1')), DecodeError);
}

TEST(ValueCodec, UnknownChoicesAndEnumeratorsAreRefused) {
  const auto bytes = [](const json& value) {
    std::string text;
    json::to_cbor(value, text);
    return text;
  };
  EXPECT_THROW(from_cbor<robot::Output>(bytes(json::array({99, json::object()}))), DecodeError);
  EXPECT_THROW(from_cbor<robot::SetMode>(bytes({{"mode", 77}})), DecodeError);
  EXPECT_THROW(from_cbor<robot::SetMode>(bytes({{"mode", -1}})), DecodeError);
  EXPECT_THROW(from_cbor<robot::SetMode>(bytes({{"mood", 0}})), DecodeError);
  EXPECT_THROW(from_cbor<robot::ScanView>(bytes(json::array())), DecodeError);
}

// ---- Whole recordings --------------------------------------------------------------------------------------------

RecordingInfo some_info() {
  RecordingInfo info{"rhine-hall", "docent 0.1.0", {}};
  info.config.seed = 0xfedcba9876543210ull;
  info.config.start = robot::Pose{0.1, 1.0 / 3.0, -2.5};
  info.config.body.lasers.at(0).max_range = 12.5;
  return info;
}

std::vector<RecordedEntry> some_entries(int count) {
  std::vector<RecordedEntry> entries;
  for (int i = 0; i < count; ++i) {
    const auto now = robot::from_seconds(0.05 * i);
    const auto n = static_cast<std::size_t>(i);
    entries.push_back(robot::Input{now, any_of<robot::Event>(n % std::variant_size_v<robot::Event>, n)});
    entries.push_back(RecordedOutput{now, any_of<robot::Output>(n % std::variant_size_v<robot::Output>, n)});
  }
  return entries;
}

std::string recorded(const std::vector<RecordedEntry>& entries, bool finish = true) {
  std::ostringstream out;
  std::string killed;
  {
    Recorder recorder(out, some_info());
    for (const auto& entry : entries) {
      if (const auto* input = std::get_if<robot::Input>(&entry)) {
        recorder.input(*input);
      } else {
        const auto& output = std::get<RecordedOutput>(entry);
        recorder.output(output.now, output.output);
      }
    }
    killed = out.str();
  }
  return finish ? out.str() : killed;
}

std::string bits_of(const RecordedEntry& entry) {
  if (const auto* input = std::get_if<robot::Input>(&entry)) return "i" + Bits::of(*input);
  const auto& output = std::get<RecordedOutput>(entry);
  return "o" + Bits::of(output.now) + Bits::of(output.output);
}

std::vector<std::string> bits_of(const std::vector<RecordedEntry>& entries) {
  std::vector<std::string> all;
  for (const auto& entry : entries) all.push_back(bits_of(entry));
  return all;
}

Recording read_back(const std::string& bytes) {
  const testing_support::TemporaryFolder folder;
  return read_recording(folder.write("day.mcap", bytes));
}

TEST(Recording, ComesBackInOrderWithItsHead) {
  const auto entries = some_entries(400);
  const auto recording = read_back(recorded(entries));
  EXPECT_FALSE(recording.cut);
  EXPECT_EQ(recording.damaged, 0);
  EXPECT_EQ(bits_of(recording.entries), bits_of(entries));
  EXPECT_EQ(recording.info.site, "rhine-hall");
  EXPECT_EQ(recording.info.software, "docent 0.1.0");
  EXPECT_EQ(recording.info.config.seed, some_info().config.seed);
  EXPECT_EQ(recording.info.config.start, some_info().config.start);
  EXPECT_EQ(Bits::of(recording.info.config.body), Bits::of(some_info().config.body));
}

TEST(Recording, KilledProcessLosesASecondAtMost) {
  const auto entries = some_entries(400);  // 20 s
  const auto recording = read_back(recorded(entries, false));
  EXPECT_TRUE(recording.cut);
  ASSERT_GE(recording.entries.size(), entries.size() - 44);
  const std::vector<RecordedEntry> kept(entries.begin(),
                                        entries.begin() + static_cast<std::ptrdiff_t>(recording.entries.size()));
  EXPECT_EQ(bits_of(recording.entries), bits_of(kept));
}

RC_GTEST_PROP(Recording, CutAnywhereKeepsAllWholeChunks, ()) {
  static const auto entries = some_entries(200);
  static const auto bytes = recorded(entries);
  const auto length = *rc::gen::inRange<std::size_t>(0, bytes.size());
  try {
    const auto recording = read_back(bytes.substr(0, length));
    RC_ASSERT(recording.damaged == 0);
    RC_ASSERT(recording.entries.size() <= entries.size());
    for (std::size_t i = 0; i < recording.entries.size(); ++i) {
      RC_ASSERT(bits_of(recording.entries[i]) == bits_of(entries[i]));
    }
  } catch (const FileError&) {
    RC_ASSERT(length < recorded({}, false).size());  // only when the head itself is cut
  }
}

RC_GTEST_PROP(Recording, DamagedFilesAreReadOrRefused, ()) {
  static const auto bytes = recorded(some_entries(60));
  try {
    const auto recording = read_back(*testing_support::damaged(bytes));
    RC_ASSERT(recording.entries.size() <= 240u);
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

TEST(Recording, FlippedByteInAChunkIsFoundAndTheRestIsRead) {
  auto bytes = recorded(some_entries(200));
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x40);
  const auto recording = read_back(bytes);
  EXPECT_GE(recording.damaged, 1);
  EXPECT_GT(recording.entries.size(), 200u);
  EXPECT_LT(recording.entries.size(), 400u);
}

TEST(Recording, IsALogForReplaysToo) {
  std::ostringstream out;
  {
    Recorder recorder(out, some_info());
    recorder.input({robot::from_seconds(1.0), robot::Odometry{robot::from_seconds(0.9), {1.0, 2.0, 0.5}, {}}});
    robot::LaserScan scan;
    scan.laser = robot::LaserId::rear;
    scan.ranges = {1.0f, 2.0f};
    recorder.input({robot::from_seconds(1.1), scan});
    recorder.output(robot::from_seconds(1.1), robot::WheelCommand{});
  }
  const testing_support::TemporaryFolder folder;
  const auto log = read_any_log(folder.write("day.mcap", out.str()));
  EXPECT_EQ(log.scans, 1u);
  ASSERT_THAT(log.entries, SizeIs(2));
  const auto& logged = std::get<LoggedScan>(log.entries[1]);
  EXPECT_EQ(logged.base_from_laser, some_info().config.body.lasers.at(1).base_from_laser);
  EXPECT_EQ(logged.scan.ranges, (std::vector<float>{1.0f, 2.0f}));
  EXPECT_EQ(read_any_log(folder.write("a.log", "ODOM 0 0 0 0 0 0 5 h 5\n")).entries.size(), 1u);
}

TEST(Recording, OtherFilesAreRefused) {
  EXPECT_THROW(read_back("hello"), FileError);
  EXPECT_THROW(read_recording("/nowhere/day.mcap"), FileError);
  std::ostringstream out;
  {
    McapWriter writer(out, "somebody else");
    writer.write(writer.add_channel("/chatter", "json", "String"), 1, "{}");
  }
  EXPECT_THROW(read_back(out.str()), FileError);
}

TEST(Recording, TimesBeforeZeroAreRefused) {
  std::ostringstream out;
  Recorder recorder(out, some_info());
  EXPECT_THROW(recorder.input({robot::from_seconds(-1.0), robot::Tick{}}), std::invalid_argument);
}

TEST(Recording, FullDiskIsNoticed) {
  std::ofstream full("/dev/full", std::ios::binary);
  if (!full) GTEST_SKIP() << "needs /dev/full";
  Recorder recorder(full, some_info());
  recorder.input({robot::from_seconds(1.0), robot::Tick{}});
  recorder.flush();
  EXPECT_FALSE(recorder.ok());
}

}  // namespace
}  // namespace files
