#include "server/recording_desk.hpp"

#include <spdlog/spdlog.h>

#include <stdexcept>

namespace server {
namespace {

constexpr int most_waiting = 20000;  // entries, some ten seconds' worth

}  // namespace

RecordingDesk::RecordingDesk(const std::filesystem::path& path, const std::string& site, const robot::Config& config)
    : file_(path, std::ios::binary | std::ios::trunc) {
  if (!file_)
    throw std::runtime_error("cannot write the recording " + path.string() + ": is its folder there and writable?");
  recorder_ = std::make_unique<files::Recorder>(
      file_, files::RecordingInfo{.site = site, .software = "docent", .config = config});
}

RecordingDesk::~RecordingDesk() {
  writer_.join();
  recorder_->finish();
}

bool RecordingDesk::accept() {
  const bool full = waiting_.load() >= most_waiting;
  if (full && !full_) spdlog::error("the recording falls behind: entries are dropped from here on");
  // A recording with a gap cannot be replayed from there on: once full, it ends.
  full_ = full_ || full;
  if (!full_) waiting_.fetch_add(1);
  return !full_;
}

void RecordingDesk::input(const robot::Input& input) {
  if (!accept()) return;
  net::post(writer_, [this, input] {
    recorder_->input(input);
    waiting_.fetch_sub(1);
  });
}

void RecordingDesk::output(const robot::Output& output, robot::Time now) {
  if (!accept()) return;
  net::post(writer_, [this, output, now] {
    recorder_->output(now, output);
    waiting_.fetch_sub(1);
  });
}

}  // namespace server
