// Writes a recording while the server runs: the robot's thread hands in inputs and outputs, a thread of its own writes
// them, so that a slow disk never delays the wheels. What the disk cannot take in time is dropped whole, and said so.
#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <filesystem>
#include <fstream>
#include <memory>

#include "protocols/files/recording.hpp"
#include "server/stream/asio.hpp"

namespace server {

class RecordingDesk {
 public:
  // Throws std::runtime_error when the file cannot be written.
  RecordingDesk(const std::filesystem::path& path, const std::string& site, const robot::Config& config);
  ~RecordingDesk();

  // The robot's thread; return at once.
  void input(const robot::Input& input);
  void output(const robot::Output& output, robot::Time now);

 private:
  bool accept();

  std::ofstream file_;
  std::unique_ptr<files::Recorder> recorder_;
  std::atomic<int> waiting_{0};
  bool full_ = false;
  net::thread_pool writer_{1};
};

}  // namespace server
