#include "server/devices/serial_line.hpp"

#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

namespace devices {
namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr auto use_tuple = asio::as_tuple(asio::use_awaitable);
constexpr std::size_t longest_queue = 512;  // bytes; more means that the device does not take them

// USB adapters hold bytes back for up to 16 ms unless asked not to. Ports that know nothing of it say so: no harm.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (::ioctl(fd, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  ::ioctl(fd, TIOCSSERIAL, &settings);
}

}  // namespace

struct SerialLine::State {
  explicit State(const asio::any_io_executor& executor) : port(executor), read_timer(executor), sleep_timer(executor) {}

  asio::serial_port port;
  asio::steady_timer read_timer, sleep_timer;
  std::array<std::uint8_t, 4096> input;
  serial::Bytes pending, writing;
  bool busy = false;
  int baud = 0;
  std::string error;
};

SerialLine::SerialLine(asio::any_io_executor executor) : state_(std::make_shared<State>(executor)) {}

SerialLine::~SerialLine() { close(); }

std::string SerialLine::open(const std::string& path, int baud) {
  close();
  state_->error.clear();
  error_code error;
  state_->port.open(path, error);
  if (error) return "cannot open " + path + ": " + error.message();
  if (::flock(state_->port.native_handle(), LOCK_EX | LOCK_NB) != 0) {
    close();
    return path + " is in use by another program";
  }
  using Port = asio::serial_port;
  state_->port.set_option(Port::character_size(8), error);
  if (!error) state_->port.set_option(Port::parity(Port::parity::none), error);
  if (!error) state_->port.set_option(Port::stop_bits(Port::stop_bits::one), error);
  if (!error) state_->port.set_option(Port::flow_control(Port::flow_control::none), error);
  if (error) {
    close();
    return path + " is not a serial line: " + error.message();
  }
  ask_for_low_latency(state_->port.native_handle());
  std::string wrong = set_baud(baud);
  if (!wrong.empty()) close();
  discard_input();
  return wrong;
}

std::string SerialLine::set_baud(int baud) {
  error_code error;
  state_->port.set_option(asio::serial_port::baud_rate(static_cast<unsigned>(baud)), error);
  if (error) return "the line does not run at " + std::to_string(baud) + " baud: " + error.message();
  state_->baud = baud;
  return {};
}

int SerialLine::baud() const { return state_->baud; }

void SerialLine::close() {
  error_code ignored;
  if (state_->port.is_open()) state_->port.close(ignored);
  state_->sleep_timer.cancel();
  state_->pending.clear();
  // State of a former port's write must not reach the next one's: it keeps its own.
  if (state_->busy) {
    auto fresh = std::make_shared<State>(state_->port.get_executor());
    fresh->error = state_->error;
    state_ = std::move(fresh);
  }
}

void SerialLine::close_with(serial::ByteSpan last_words) {
  if (state_->port.is_open()) {
    serial::Bytes bytes = state_->pending;
    bytes.insert(bytes.end(), last_words.begin(), last_words.end());
    // A tty takes some 4 KiB at once; one that does not is stuck, and nothing could be done for it.
    if (::write(state_->port.native_handle(), bytes.data(), bytes.size()) < 0) state_->error = "the line broke";
  }
  close();
}

void SerialLine::discard_input() {
  if (state_->port.is_open()) ::tcflush(state_->port.native_handle(), TCIFLUSH);
}

asio::awaitable<SerialLine::ReadResult> SerialLine::read(std::chrono::steady_clock::duration timeout) {
  const auto state = state_;
  state->read_timer.expires_after(timeout);
  state->read_timer.async_wait([state](error_code error) {
    const bool due = state->read_timer.expiry() <= std::chrono::steady_clock::now();
    if (!error && due) state->port.cancel(error);
  });
  const auto [error, count] = co_await state->port.async_read_some(asio::buffer(state->input), use_tuple);
  // Also disarms a wait that has fired but not run yet.
  state->read_timer.expires_at(std::chrono::steady_clock::time_point::max());
  if (!error) co_return ReadResult{ReadState::bytes, serial::ByteSpan(state->input).first(count)};
  if (error == asio::error::operation_aborted && state->port.is_open()) co_return ReadResult{ReadState::timed_out, {}};
  if (state->error.empty()) state->error = "the line broke: " + error.message();
  co_return ReadResult{ReadState::broken, {}};
}

bool SerialLine::write(serial::ByteSpan bytes) {
  if (!state_->port.is_open() || !state_->error.empty()) return false;
  if (state_->pending.size() + bytes.size() > longest_queue) {
    state_->error = "the device does not take what is sent to it";
    return false;
  }
  state_->pending.insert(state_->pending.end(), bytes.begin(), bytes.end());
  if (state_->busy) return true;
  struct Flush {
    std::shared_ptr<State> state;
    void operator()(error_code error, std::size_t) {
      state->busy = false;
      if (error && state->error.empty()) state->error = "the line broke: " + error.message();
      if (!error) start(std::move(state));
    }
    static void start(std::shared_ptr<State> state) {
      if (state->pending.empty()) return;
      state->busy = true;
      state->writing.swap(state->pending);
      state->pending.clear();
      State& s = *state;
      asio::async_write(s.port, asio::buffer(s.writing), Flush{std::move(state)});
    }
  };
  Flush::start(state_);
  return true;
}

asio::awaitable<bool> SerialLine::write_slowly(serial::ByteSpan bytes, std::chrono::steady_clock::duration gap) {
  for (const std::uint8_t& byte : bytes) {
    if (!write({&byte, 1})) co_return false;
    co_await sleep(gap);
  }
  co_return true;
}

asio::awaitable<void> SerialLine::sleep(std::chrono::steady_clock::duration duration) {
  const auto state = state_;
  state->sleep_timer.expires_after(duration);
  co_await state->sleep_timer.async_wait(use_tuple);
}

const std::string& SerialLine::error() const { return state_->error; }

}  // namespace devices
