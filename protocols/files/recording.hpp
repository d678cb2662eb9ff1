// Recordings of a robot's life: every input and every output in the order in which they came, as an MCAP file of two
// channels, /input and /output, whose messages are CBOR. The same inputs handed to a robot of the same museum and
// settings give the same outputs.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocols/files/mcap.hpp"
#include "protocols/files/sensor_log.hpp"
#include "robot/config.hpp"
#include "robot/inputs.hpp"
#include "robot/outputs.hpp"

namespace files {

// What a replay needs beside the inputs. Of the settings, body, start and seed are kept; the modules' own tuning is the
// program's, whose version stands beside it.
struct RecordingInfo {
  std::string site;      // the museum's id
  std::string software;  // name and version
  robot::Config config;
};

// Values in, bytes out. The stream must be binary and outlive the recorder. At most a second is lost when the process
// is killed.
class Recorder {
 public:
  Recorder(std::ostream& out, const RecordingInfo& info);

  // Times before zero are refused with std::invalid_argument: MCAP counts from zero.
  void input(const robot::Input& input);
  // now: of the input that it answers.
  void output(robot::Time now, const robot::Output& output);
  // Hands on what is kept, for example after an incident.
  void flush() { writer_.flush(); }
  // Writes the index; the destructor does it too.
  void finish() { writer_.finish(); }
  // False once the stream has failed.
  bool ok() const { return writer_.ok(); }

 private:
  McapWriter writer_;
  std::uint16_t inputs_ = 0;
  std::uint16_t outputs_ = 0;
};

struct RecordedOutput {
  robot::Time now;
  robot::Output output;
};
using RecordedEntry = std::variant<robot::Input, RecordedOutput>;

// Goes through a recording from the beginning.
class RecordingReader {
 public:
  // Throws FileError when it is no recording.
  RecordingReader(std::istream& in, const std::string& name);

  const RecordingInfo& info() const { return info_; }
  // The next entry, or nothing at the end. An entry that cannot be decoded is left out and counted.
  std::optional<RecordedEntry> next();
  // True when the recording has no proper end: whole chunks until then were read.
  bool cut() const { return reader_.cut(); }
  // Entries and chunks that were left out.
  int damaged() const { return damaged_ + reader_.damaged_chunks(); }

 private:
  McapReader reader_;
  RecordingInfo info_;
  std::optional<McapMessage> first_;
  int damaged_ = 0;
};

struct Recording {
  RecordingInfo info;
  std::vector<RecordedEntry> entries;
  bool cut = false;
  int damaged = 0;
};

// What the robot's wheels and lasers said in the course of a recording.
SensorLog sensor_log_of(RecordingReader& reader, const std::string& name);

// A log of any kind that is known here: CARMEN's, the Wean course's (see sensor_log.hpp), or a recording.
// Throws FileError when nothing can be read.
SensorLog read_any_log(const std::filesystem::path& path);

// All of a recording at once. Throws FileError.
Recording read_recording(const std::filesystem::path& path);

}  // namespace files
