#include "server/devices/simulated_sick.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace devices {
namespace sick = serial::sick;
using serial::Bytes;
using serial::ByteSpan;

namespace {

constexpr Duration mirror_turn = 13'333'333ns;
constexpr Duration half_sweep = 3'333'333ns;  // from the middle of 180 degrees to their end
constexpr Duration telegram_gap = 100ms;      // a half-received telegram is dropped after this pause
constexpr Instant never = Instant::max();

int baud_of(std::uint8_t mode) {
  switch (mode) {
    case sick::mode::baud_9600:
      return 9600;
    case sick::mode::baud_19200:
      return 19200;
    case sick::mode::baud_38400:
      return 38400;
    case sick::mode::baud_500000:
      return 500000;
    default:
      return 0;
  }
}

}  // namespace

SimulatedSick::SimulatedSick(SimulatedSickConfig config, Instant now)
    : options_(std::move(config)),
      last_byte_(now),
      baud_(options_.baud),
      mirror_(now),
      capture_due_(never),
      line_free_(now),
      send_due_(never) {
  block_.size = options_.config_bytes;
}

void SimulatedSick::receive(ByteSpan bytes, Instant now) {
  if (booted_) return;  // its self-test hears nothing
  if (now - last_byte_ > telegram_gap) {
    decoder_.line_fell_silent();
    obey_all(now);
  }
  last_byte_ = now;
  decoder_.feed(bytes);
  obey_all(now);
  if (decoder_.counts().bad_checksums == bad_checksums_) return;
  bad_checksums_ = decoder_.counts().bad_checksums;
  if (!silent_) output_.push_back(sick::nak);
}

void SimulatedSick::obey_all(Instant now) {
  while (const auto item = decoder_.next()) obey(item->payload, now);
}

void SimulatedSick::reply(const Bytes& telegram) {
  if (!silent_) output_.insert(output_.end(), telegram.begin(), telegram.end());
}

void SimulatedSick::obey(ByteSpan payload, Instant now) {
  namespace response = sick::response;
  const ByteSpan arguments = payload.subspan(1);
  const std::uint8_t acknowledgement[] = {sick::ack};
  reply({std::begin(acknowledgement), std::end(acknowledgement)});
  switch (payload[0]) {
    case sick::command::reset:
      answer(response::reset, {});
      mode_ = sick::mode::on_request;
      capture_due_ = send_due_ = never;
      booted_ = now + options_.boot;
      break;
    case sick::command::mode:
      change_mode(arguments, now);
      break;
    case sick::command::poll:
      if (arguments.size() != 1 || arguments[0] != 0x01) return answer(response::rejected, {});
      poll_ = true;
      if (!streaming()) schedule(now);
      break;
    case sick::command::status:
      reply(status_block());
      break;
    case sick::command::errors:
      answer(response::errors, {});
      break;
    case sick::command::type: {
      const Bytes type(options_.type.begin(), options_.type.end());
      answer(response::type, type);
      break;
    }
    case sick::command::variant:
      change_variant(arguments);
      break;
    case sick::command::get_config:
      answer(response::config, block_.block());
      break;
    case sick::command::set_config:
      change_config(arguments, now);
      break;
    default:
      answer(response::rejected, {});
  }
}

void SimulatedSick::change_mode(ByteSpan arguments, Instant now) {
  if (arguments.empty()) return answer(sick::response::rejected, {});
  const std::uint8_t wanted = arguments[0];
  const int rate = baud_of(wanted);
  const bool accepted = rate != 0 || enter(wanted, arguments.subspan(1));
  const std::uint8_t verdict[] = {accepted ? std::uint8_t{0} : std::uint8_t{1}};
  answer(sick::response::mode, verdict);
  if (rate != 0) {
    baud_ = rate;  // the answer has left at the old one
  } else if (accepted) {
    partial_ = 0;
    capture_due_ = send_due_ = never;
    poll_ = false;
    if (streaming()) schedule(now);
  }
}

// Whether the scanner goes into this mode; false when its arguments are wrong or it cannot do it.
bool SimulatedSick::enter(std::uint8_t wanted, ByteSpan arguments) {
  serial::ByteReader in(arguments);
  unsigned mean_of = 1, first = 1, last = variant_.values();
  switch (wanted) {
    case sick::mode::install:
      if (!std::equal(arguments.begin(), arguments.end(), sick::lms_password.begin(), sick::lms_password.end())) {
        return false;
      }
      break;
    case sick::mode::diagnostic:
    case sick::mode::stream:
    case sick::mode::on_request:
    case sick::mode::stream_partial:
      break;
    case sick::mode::stream_mean_sub_range:
    case sick::mode::stream_mean:
      mean_of = in.u8();
      if (wanted == sick::mode::stream_mean) break;
      [[fallthrough]];
    case sick::mode::stream_sub_range:
      first = in.u16();
      last = in.u16();
      break;
    default:
      return false;  // remission and reflectivity: other models
  }
  if (!in.ok() || mean_of < 1 || first < 1 || last < first || last > variant_.values()) return false;
  mode_ = wanted;
  mean_of_ = mean_of;
  first_ = first;
  last_ = last;
  return true;
}

void SimulatedSick::change_variant(ByteSpan arguments) {
  serial::ByteReader in(arguments);
  const sick::Variant wanted{in.u16(), in.u16()};
  const bool accepted = in.ok() && wanted.possible();
  if (accepted) {
    variant_ = wanted;
    if (mode_ != sick::mode::install) mode_ = sick::mode::on_request;
    capture_due_ = send_due_ = never;
  }
  serial::ByteWriter data;
  data.u8(accepted).u16(variant_.angle_deg).u16(variant_.resolution_cdeg);
  answer(sick::response::variant, data.take());
}

// Hosts send blocks of different lengths: what they send replaces the beginning, the rest stays.
void SimulatedSick::change_config(ByteSpan block, Instant now) {
  const bool accepted =
      mode_ == sick::mode::install && !block.empty() && block.size() <= block_.bytes.size() && !config_written_;
  if (accepted) {
    sick::Config wanted = block_;
    std::copy(block.begin(), block.end(), wanted.bytes.begin());
    if (sick::range_bits(wanted.measuring_mode()) && wanted.bytes[6] <= 2) {
      block_ = wanted;
      config_written_ = now + options_.config_write;
      return;
    }
  }
  answer(sick::response::config_set, serial::ByteWriter().u8(0).append(block_.block()).take());
}

Bytes SimulatedSick::status_block() const {
  sick::StatusBlock status;
  status.version = "V02.10 ";
  status.operating_mode = mode_;
  status.error = sick::severity(status_) >= sick::Severity::error;
  status.motor_revolutions = 4500;
  status.measuring_mode = block_.measuring_mode();
  status.variant = variant_;
  status.baud = static_cast<unsigned>(baud_);
  status.units = block_.units();
  return sick::encode_status(status);
}

bool SimulatedSick::streaming() const {
  return mode_ >= sick::mode::stream && mode_ != sick::mode::on_request && mode_ < sick::mode::baud_38400;
}

Duration SimulatedSick::turns(unsigned count) const { return count * mirror_turn; }

// Half-degree steps need two turns of the mirror, quarter degrees four, a mean as many as it averages; a partial scan
// one.
Duration SimulatedSick::scan_period() const {
  if (mode_ == sick::mode::stream_partial) return turns(1);
  return turns(100 / variant_.resolution_cdeg * (streaming() ? mean_of_ : 1));
}

// The next scan is the first whole one that finds the line free at its end.
void SimulatedSick::schedule(Instant not_before) {
  const Instant earliest = std::max(not_before, line_free_ - half_sweep);
  const Duration period = scan_period();
  const auto passed = (earliest - mirror_ + period - Duration(1)) / period;
  capture_due_ = mirror_ + passed * period;
}

void SimulatedSick::capture(Instant now) {
  sick::Values values =
      frozen_ && !last_values_.values.empty()
          ? last_values_
          : sick::from_laser_scan(options_.scan(), {variant_, block_.measuring_mode(), block_.units()});
  values.status = status_;
  last_values_ = values;
  const bool request = std::exchange(poll_, false);
  if (!request && mode_ == sick::mode::stream_partial) {
    // Every turn measures whole degrees, from a start that moves on by the resolution.
    const unsigned step = 100 / variant_.resolution_cdeg;
    std::vector<std::uint16_t> whole;
    for (std::size_t i = static_cast<std::size_t>(partial_); i < values.values.size(); i += step)
      whole.push_back(values.values[i]);
    values.values = std::move(whole);
    values.partial = partial_ * static_cast<int>(variant_.resolution_cdeg) / 25;
    partial_ = (partial_ + 1) % static_cast<int>(step);
  } else if (!request) {
    const bool part = mode_ == sick::mode::stream_sub_range || mode_ == sick::mode::stream_mean_sub_range;
    const bool mean = mode_ == sick::mode::stream_mean || mode_ == sick::mode::stream_mean_sub_range;
    values.id = part && mean ? sick::response::mean_sub_range
                : part       ? sick::response::sub_range
                : mean       ? sick::response::mean
                             : sick::response::scan;
    values.mean_of = mean_of_;
    if (part) {
      values.first = first_;
      values.last = last_;
      values.values = {values.values.begin() + (first_ - 1), values.values.begin() + last_};
    }
  }
  std::optional<std::uint16_t> indices;
  if (block_.sends_indices()) indices = static_cast<std::uint16_t>(scan_number_ << 8 | scan_number_);
  ++scan_number_;
  telegram_ = sick::encode_values(values, indices);
  const auto on_the_line = std::chrono::duration_cast<Duration>(transmission_time(telegram_.size(), baud_));
  send_due_ = line_free_ = std::max(now, capture_due_ + half_sweep) + on_the_line;
  capture_due_ = never;
}

void SimulatedSick::advance(Instant now) {
  if (booted_ && now >= *booted_) {
    booted_.reset();
    baud_ = options_.baud;
    const Bytes type(options_.type.begin(), options_.type.end());
    answer(sick::response::power_on, type);
  }
  if (config_written_ && now >= *config_written_) {
    config_written_.reset();
    answer(sick::response::config_set, serial::ByteWriter().u8(1).append(block_.block()).take());
  }
  if (now >= send_due_) {
    reply(telegram_);
    send_due_ = never;
    if (streaming() || poll_) schedule(now);
  }
  if (now >= capture_due_) capture(now);
}

Instant SimulatedSick::due() const {
  return std::min({capture_due_, send_due_, booted_.value_or(never), config_written_.value_or(never)});
}

}  // namespace devices
