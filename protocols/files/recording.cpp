#include "protocols/files/recording.hpp"

#include <fstream>
#include <stdexcept>

#include "protocols/files/mcap_format.hpp"
#include "protocols/files/problem.hpp"
#include "protocols/files/value_codec.hpp"

namespace files {
namespace {

constexpr const char* metadata_name = "docent";
constexpr const char* format = "1";

std::uint64_t stamp(robot::Time time) {
  const auto ns = time.time_since_epoch().count();
  if (ns < 0) throw std::invalid_argument("recording: a time before zero");
  return static_cast<std::uint64_t>(ns);
}

template <typename T>
T decoded(const std::string& text) {
  T value;
  decode(json::parse(text), value);
  return value;
}

RecordingInfo info_of(const std::map<std::string, std::string>& values, const std::string& name) {
  const auto value = [&](const char* key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string() : found->second;
  };
  if (value("format") != format) {
    throw FileError({name, 0, "is a recording of another format \"" + value("format") + "\"",
                     std::string("give one of format ") + format});
  }
  try {
    RecordingInfo info{value("site"), value("software"), {}};
    info.config.seed = decoded<std::uint64_t>(value("seed"));
    info.config.start = decoded<std::optional<robot::Pose>>(value("start"));
    info.config.body = decoded<robot::Body>(value("body"));
    return info;
  } catch (const std::exception& error) {
    throw FileError({name, 0, std::string("its head is damaged: ") + error.what(), "give another recording"});
  }
}

}  // namespace

Recorder::Recorder(std::ostream& out, const RecordingInfo& info) : writer_(out, info.software) {
  writer_.metadata(metadata_name, {{"format", format},
                                   {"site", info.site},
                                   {"software", info.software},
                                   {"seed", encode(info.config.seed).dump()},
                                   {"start", encode(info.config.start).dump()},
                                   {"body", encode(info.config.body).dump()}});
  inputs_ = writer_.add_channel("/input", "cbor", "docent.Input");
  outputs_ = writer_.add_channel("/output", "cbor", "docent.Output");
}

void Recorder::input(const robot::Input& input) { writer_.write(inputs_, stamp(input.now), to_cbor(input)); }

void Recorder::output(robot::Time now, const robot::Output& output) {
  writer_.write(outputs_, stamp(now), to_cbor(output));
}

RecordingReader::RecordingReader(std::istream& in, const std::string& name) : reader_(in, name) {
  first_ = reader_.next();
  const auto found = reader_.metadata().find(metadata_name);
  if (found == reader_.metadata().end()) {
    throw FileError({name, 0, "is not one of Docent's recordings", "give a file that docent has recorded"});
  }
  info_ = info_of(found->second, name);
}

std::optional<RecordedEntry> RecordingReader::next() {
  while (auto message = first_ ? std::exchange(first_, std::nullopt) : reader_.next()) {
    const auto channel = reader_.channels().find(message->channel);
    if (channel == reader_.channels().end()) continue;
    try {
      if (channel->second.topic == "/input") return from_cbor<robot::Input>(message->data);
      if (channel->second.topic == "/output") {
        const robot::Time now{robot::RobotClock::duration(static_cast<std::int64_t>(message->time))};
        return RecordedOutput{now, from_cbor<robot::Output>(message->data)};
      }
    } catch (const DecodeError&) {
      ++damaged_;
    }
  }
  return std::nullopt;
}

SensorLog sensor_log_of(RecordingReader& reader, const std::string& name) {
  SensorLog log;
  log.name = name;
  const auto& lasers = reader.info().config.body.lasers;
  while (const auto entry = reader.next()) {
    const auto* input = std::get_if<robot::Input>(&*entry);
    if (!input) continue;
    if (const auto* odometry = std::get_if<robot::Odometry>(&input->event)) log.entries.emplace_back(*odometry);
    const auto* scan = std::get_if<robot::LaserScan>(&input->event);
    if (!scan || static_cast<std::size_t>(scan->laser) >= lasers.size()) continue;
    log.entries.emplace_back(LoggedScan{*scan, lasers[static_cast<std::size_t>(scan->laser)].base_from_laser, -1});
    ++log.scans;
  }
  log.bad_lines = static_cast<std::size_t>(reader.damaged());
  if (log.scans == 0) throw FileError({name, 0, "holds no scans", "give a recording of a drive"});
  return log;
}

SensorLog read_any_log(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string head(mcap::magic.size(), '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head != mcap::magic) return read_log(path);
  in.seekg(0);
  RecordingReader reader(in, path.string());
  return sensor_log_of(reader, path.string());
}

Recording read_recording(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError({path.string(), 0, "cannot be opened", "check the name"});
  RecordingReader reader(in, path.string());
  Recording recording{reader.info(), {}, false, 0};
  while (auto entry = reader.next()) recording.entries.push_back(std::move(*entry));
  recording.cut = reader.cut();
  recording.damaged = reader.damaged();
  return recording;
}

}  // namespace files
