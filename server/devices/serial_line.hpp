// A serial port for coroutines: every read has a time-out, writes are queued and bounded. Nothing throws; what goes
// wrong is told in words. One executor, no thread of its own.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "protocols/serial/bytes.hpp"

namespace devices {

class SerialLine {
 public:
  explicit SerialLine(boost::asio::any_io_executor executor);
  ~SerialLine();
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  // Opens a tty or pty raw, 8N1, alone on it (advisory lock). Returns what is wrong, or an empty string.
  std::string open(const std::string& path, int baud);
  std::string set_baud(int baud);
  int baud() const;
  void close();
  // Writes what the line takes without waiting, then closes it.
  void close_with(serial::ByteSpan last_words);
  // Throws away what came in and was not read.
  void discard_input();

  enum class ReadState { bytes, timed_out, broken };
  struct ReadResult {
    ReadState state = ReadState::broken;
    serial::ByteSpan bytes;  // valid until the next read
  };
  boost::asio::awaitable<ReadResult> read(std::chrono::steady_clock::duration timeout);

  // Goes out at once when the line takes it. False when the line is stuck or broken.
  bool write(serial::ByteSpan bytes);
  // One byte at a time with a gap between: some devices cannot take them faster.
  boost::asio::awaitable<bool> write_slowly(serial::ByteSpan bytes, std::chrono::steady_clock::duration gap);
  boost::asio::awaitable<void> sleep(std::chrono::steady_clock::duration duration);
  // Why a read or write failed.
  const std::string& error() const;

 private:
  struct State;
  std::shared_ptr<State> state_;  // shared with the operations under way
};

}  // namespace devices
