#include "server/devices/sick_link.hpp"

#include <spdlog/spdlog.h>

#include <optional>
#include <utility>
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "protocols/serial/sick_scan.hpp"
#include "server/devices/serial_line.hpp"

namespace devices {
namespace asio = boost::asio;
namespace sick = serial::sick;
using asio::awaitable;
using serial::Bytes;
using serial::ByteSpan;

namespace {

constexpr auto half_sweep = 3333us;  // 180 degrees of a mirror that turns 75 times a second, halved
constexpr auto byte_gap = 60us;      // at 500 kbaud the scanner needs about 55 us between a host's bytes
constexpr auto frame_gap = 30ms;     // a pause this long inside a telegram ends it
constexpr auto rate_change_settles = 50ms;
constexpr auto freeze_limit = 300ms;  // a scanner whose numbers stay the same to the last digit for so long is stuck
constexpr int freeze_scans = 8;

// Mirror at 75 turns a second; finer steps need several turns.
std::chrono::duration<double> scan_period(sick::Variant variant, int baud) {
  const double mirror = (100.0 / variant.resolution_cdeg) / 75.0;
  return std::max(std::chrono::duration<double>(mirror), transmission_time(2 * variant.values() + 10, baud));
}

// A telegram of scans may have to end first.
Duration acknowledges_within(int baud) {
  return 150ms + std::chrono::duration_cast<Duration>(transmission_time(800, baud));
}

robot::Device device_of(robot::LaserId laser) {
  return laser == robot::LaserId::front ? robot::Device::laser_front : robot::Device::laser_rear;
}

std::string hex(unsigned value) { return fmt::format("0x{:02x}", value); }

}  // namespace

class SickLink::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(asio::any_io_executor executor, SickLinkConfig config, Clock clock, EventSink sink)
      : config_(std::move(config)),
        clock_(std::move(clock)),
        sink_(std::move(sink)),
        line_(executor),
        executor_(executor) {}

  void start() {
    asio::co_spawn(
        executor_, [self = shared_from_this()] { return self->run(); }, asio::detached);
  }

  void stop() {
    if (stopping_) return;
    stopping_ = true;
    line_.close_with(sick::set_mode(sick::mode::on_request));
  }

  LineStatistics statistics() const {
    LineStatistics out = statistics_;
    out.frames += decoder_.counts().frames;
    out.bad_checksums += decoder_.counts().bad_checksums;
    out.skipped_bytes += decoder_.counts().skipped_bytes;
    return out;
  }

 private:
  // Empty: all is well. Otherwise why not, in words for staff.
  using Trouble = std::string;
  struct Answer {
    enum State { answered, refused, silent, broken } state = silent;
    Bytes data;
  };

  awaitable<void> run() {
    while (!stopping_) {
      const Trouble trouble = co_await connect_and_stream();
      line_.close();
      if (stopping_) co_return;
      report_lost(trouble);
      co_await line_.sleep(backoff_.next());
    }
  }

  awaitable<Trouble> connect_and_stream() {
    const auto counted = statistics();
    statistics_ = counted;
    decoder_ = sick::TelegramDecoder(sick::Sender::sensor);
    Trouble trouble = line_.open(config_.path, config_.baud);
    if (!trouble.empty() && config_.baud > 38400) trouble = line_.open(config_.path, 38400);
    if (trouble.empty()) trouble = co_await find_rate();
    if (trouble.empty()) trouble = co_await change_rate();
    if (trouble.empty()) trouble = co_await set_up();
    if (trouble.empty()) trouble = co_await start_stream();
    if (trouble.empty()) trouble = co_await stream();
    co_return trouble;
  }

  // The scanner keeps its rate until it is switched off; nobody knows which one that is.
  awaitable<Trouble> find_rate() {
    const int wanted = line_.baud();
    for (const int rate : rates_to_try({statistics_.baud, wanted, 9600, 38400, 19200, 500000})) {
      if (stopping_ || !line_.set_baud(rate).empty()) continue;
      // Twice: the first probe may meet a line full of scans, or the rest of someone else's telegram.
      for (int attempt = 0; attempt < 2; ++attempt) {
        const auto answer =
            co_await request(sick::set_mode(sick::mode::on_request), sick::response::mode, acknowledges_within(rate));
        if (answer.state == Answer::broken) co_return line_.error();
        if (answer.state == Answer::answered) {
          wanted_baud_ = wanted;
          co_return Trouble();
        }
      }
    }
    co_return "no answer from the laser on " + config_.path + " at any rate";
  }

  awaitable<Trouble> change_rate() {
    const auto change = sick::set_baud(wanted_baud_);
    const int old = line_.baud();
    if (change && wanted_baud_ != old) {
      auto answer = co_await request(*change, sick::response::mode, 1s);
      if (answer.state == Answer::refused) answer = co_await request(*change, sick::response::mode, 1s);
      if (answer.state == Answer::broken) co_return line_.error();
      const bool accepted = answer.state == Answer::answered && !answer.data.empty() && answer.data[0] == 0;
      if (accepted || answer.state == Answer::silent) {  // the scanner may have changed although its answer was lost
        line_.set_baud(wanted_baud_);
        co_await line_.sleep(rate_change_settles);
        const auto check = co_await insist(sick::set_mode(sick::mode::on_request), sick::response::mode, 500ms);
        if (check.state != Answer::answered)
          co_return "the laser was lost when changing to " + std::to_string(wanted_baud_) + " baud";
      }
    }
    statistics_.baud = line_.baud();
    co_return Trouble();
  }

  // Type, configuration and variant. A scanner that refuses 32 m in millimetres is used as it is.
  awaitable<Trouble> set_up() {
    const auto type = co_await insist(sick::ask(sick::command::type), sick::response::type, 1s);
    if (type.state == Answer::broken) co_return line_.error();
    statistics_.identity.assign(type.data.begin(), type.data.end());

    const auto block = co_await insist(sick::ask(sick::command::get_config), sick::response::config, 1s);
    const auto config = sick::parse_config(block.data);
    if (!config) co_return "the laser does not tell its configuration";
    sick::Config wanted = *config;
    if (sick::max_range(config->measuring_mode(), config->units()) < 32.0 || config->units() != sick::Units::mm) {
      wanted.measuring_mode() = sick::measuring::range_32m;
      wanted.set_units(sick::Units::mm);
    }
    // Only when it differs: the block lives in an EEPROM that wears out.
    std::optional<sick::Config> in_force = config;
    for (int times = 0; times < 3 && in_force && *in_force != wanted; ++times) in_force = co_await write_config(wanted);
    if (!in_force) co_return "the laser does not tell its configuration";
    if (*in_force != wanted) spdlog::warn("{}: the laser keeps its measuring mode", config_.path);
    geometry_.measuring_mode = in_force->measuring_mode();
    const auto variant = co_await insist(sick::set_variant(config_.variant), sick::response::variant, 2s);
    const auto reply = sick::parse_variant_reply(variant.data);
    if (!reply) co_return "the laser does not answer which angles it scans";
    geometry_.variant = reply->variant;
    if (!reply->accepted) spdlog::warn("{}: the laser refuses the wanted angles and keeps its own", config_.path);
    if (!geometry_.variant.possible() || !sick::range_bits(geometry_.measuring_mode)) {
      co_return "the laser is set to measure something else than ranges (mode " + hex(geometry_.measuring_mode) + ")";
    }
    co_return Trouble();
  }

  // The configuration in force afterwards, as the scanner tells it when asked: an answer to the writing may be lost.
  awaitable<std::optional<sick::Config>> write_config(const sick::Config& wanted) {
    const auto install = co_await insist(sick::install_mode(), sick::response::mode, 3s);
    if (install.state == Answer::answered && !install.data.empty() && install.data[0] == 0)
      co_await request(sick::set_config(wanted), sick::response::config_set, 15s, acknowledges_within(line_.baud()));
    co_await insist(sick::set_mode(sick::mode::on_request), sick::response::mode, 3s);
    const auto block = co_await insist(sick::ask(sick::command::get_config), sick::response::config, 1s);
    co_return sick::parse_config(block.data);
  }

  awaitable<Trouble> start_stream() {
    const auto answer = co_await insist(sick::set_mode(sick::mode::stream), sick::response::mode, 3s);
    if (answer.state == Answer::broken) co_return line_.error();
    const bool accepted = answer.state == Answer::answered && !answer.data.empty() && answer.data[0] == 0;
    co_return accepted ? Trouble() : "the laser refuses to stream";
  }

  awaitable<Trouble> stream() {
    const auto patience = silence_limit(scan_period(geometry_.variant, line_.baud()));
    last_good_ = last_change_ = std::chrono::steady_clock::now();
    worthless_status_ = 0;
    noise_ = {};
    for (;;) {
      while (const auto item = decoder_.next()) {
        if (item->kind == sick::Item::telegram) take_scan(item->payload);
      }
      const auto now = std::chrono::steady_clock::now();
      if (now - last_good_ > patience) {
        if (worthless_status_) co_return "the laser reports an error (status " + hex(worthless_status_) + ")";
        co_return fmt::format("no scan for {} ms",
                              std::chrono::duration_cast<std::chrono::milliseconds>(patience).count());
      }
      if (noise_.too_noisy(decoder_.counts().frames, decoder_.counts().bad_checksums, now)) {
        co_return "the line is too noisy: many damaged telegrams";
      }
      if (same_scans_ >= freeze_scans && now - last_change_ > freeze_limit) co_return "the laser repeats the same scan";
      const auto read = co_await line_.read(std::max<Duration>(1ms, patience - (now - last_good_)));
      if (read.state == SerialLine::ReadState::broken || stopping_) co_return line_.error();
      decoder_.feed(read.bytes);
    }
  }

  void take_scan(ByteSpan payload) {
    const auto values = sick::parse_values(payload);
    if (!values || values->id != sick::response::scan) return;
    if (config_.heed_status && sick::severity(values->status) >= sick::Severity::error) {
      worthless_status_ = values->status;
      return;
    }
    auto scan = sick::to_laser_scan(*values, geometry_, config_.laser);
    if (!scan) return;
    const auto now = std::chrono::steady_clock::now();
    last_good_ = now;
    same_scans_ = values->values == last_values_ ? same_scans_ + 1 : 0;
    if (same_scans_ == 0) {
      last_change_ = now;
      last_values_ = values->values;
    }
    scan->time = clock_() - robot::Seconds(transmission_time(payload.size() + 6, line_.baud()) + half_sweep);
    report_connected();
    if (!stopping_) sink_(std::move(*scan));
  }

  // Sends a telegram and waits for its answer; scans that are still in the pipe are let go by. The scanner acknowledges
  // at once what it understood: without that in `heard_within` there is nothing to wait for.
  awaitable<Answer> request(Bytes telegram, std::uint8_t id, Duration patience,
                            Duration heard_within = Duration::max()) {
    Answer answer;
    const auto sent_at = std::chrono::steady_clock::now();
    bool heard = false;
    const bool sent = line_.baud() > 38400 ? co_await line_.write_slowly(telegram, byte_gap) : line_.write(telegram);
    if (!sent) answer.state = Answer::broken;
    while (sent && !stopping_) {
      while (const auto item = decoder_.next()) {
        if (item->kind == sick::Item::acknowledged) heard = true;
        if (item->kind == sick::Item::refused) answer.state = Answer::refused;
        if (item->kind == sick::Item::telegram && take_answer(item->payload, id, answer)) co_return answer;
      }
      const auto left =
          (heard ? patience : std::min(patience, heard_within)) - (std::chrono::steady_clock::now() - sent_at);
      if (left <= Duration::zero()) break;
      const auto read = co_await line_.read(std::min<Duration>(left, frame_gap));
      if (read.state == SerialLine::ReadState::broken) {
        answer.state = Answer::broken;
        break;
      }
      if (read.state == SerialLine::ReadState::timed_out) decoder_.line_fell_silent();
      decoder_.feed(read.bytes);
      if (answer.state == Answer::refused && read.state == SerialLine::ReadState::timed_out) break;
    }
    co_return answer;
  }

  // Says it again when no answer comes or it was not understood, for what may be said twice: one damaged telegram must
  // not begin the whole set-up anew.
  awaitable<Answer> insist(Bytes telegram, std::uint8_t id, Duration patience) {
    const auto heard_within = acknowledges_within(line_.baud());
    Answer answer;
    for (int times = 0; times < 6 && !stopping_; ++times) {
      answer = co_await request(telegram, id, patience, heard_within);
      if (answer.state == Answer::answered || answer.state == Answer::broken) break;
    }
    co_return answer;
  }

  static bool take_answer(ByteSpan payload, std::uint8_t id, Answer& answer) {
    const auto reply = sick::parse_reply(payload);
    if (!reply) return false;
    if (reply->id == sick::response::rejected) {
      answer.state = Answer::refused;
      return true;
    }
    if (reply->id != id) return false;
    answer.state = Answer::answered;
    answer.data.assign(reply->data.begin(), reply->data.end());
    return true;
  }

  void report_connected() {
    backoff_.reset();
    last_trouble_.reset();
    if (std::exchange(statistics_.connected, true) || stopping_) return;
    ++statistics_.connections;
    spdlog::info("{}: {} at {} baud", config_.path, statistics_.identity, line_.baud());
    sink_(robot::DeviceState{device_of(config_.laser), true, {}});
  }

  void report_lost(const Trouble& trouble) {
    const bool was_connected = std::exchange(statistics_.connected, false);
    if (!was_connected && last_trouble_ == trouble) return;
    last_trouble_ = trouble;
    spdlog::warn("{}: {}", config_.path, trouble);
    sink_(robot::DeviceState{device_of(config_.laser), false, trouble});
  }

  SickLinkConfig config_;
  Clock clock_;
  EventSink sink_;
  SerialLine line_;
  asio::any_io_executor executor_;
  bool stopping_ = false;
  sick::TelegramDecoder decoder_{sick::Sender::sensor};
  sick::Geometry geometry_;
  int wanted_baud_ = 0;
  Backoff backoff_;
  NoiseGauge noise_;
  std::optional<Trouble> last_trouble_;
  LineStatistics statistics_;
  Instant last_good_, last_change_;
  std::vector<std::uint16_t> last_values_;
  int same_scans_ = 0;
  std::uint8_t worthless_status_ = 0;
};

SickLink::SickLink(asio::any_io_executor executor, SickLinkConfig config, Clock clock, EventSink sink)
    : session_(std::make_shared<Session>(executor, std::move(config), std::move(clock), std::move(sink))) {}
SickLink::~SickLink() {
  if (session_) session_->stop();
}
void SickLink::start() { session_->start(); }
void SickLink::stop() { session_->stop(); }
LineStatistics SickLink::statistics() const { return session_->statistics(); }

}  // namespace devices
