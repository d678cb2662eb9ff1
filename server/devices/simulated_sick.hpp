// A SICK LMS 200 as its host sees it: every command of the reference, telegrams byte for byte, scans in the rhythm of a
// mirror that turns 75 times a second and of the line's rate.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "protocols/serial/sick_scan.hpp"
#include "server/devices/simulated_device.hpp"

namespace devices {

struct SimulatedSickConfig {
  std::function<robot::LaserScan()> scan{};  // what the scanner sees now
  std::string type = "LMS200;30106;V02.10 ";
  int baud = 9600;                // at power-on, and after a reset
  Duration config_write = 80ms;   // real ones take up to seconds, some hosts wait for one
  Duration boot = 1s;             // real ones: 30 to 60 s
  std::size_t config_bytes = 34;  // firmware comes in 32 and 34
};

class SimulatedSick : public SimulatedDevice {
 public:
  SimulatedSick(SimulatedSickConfig config, Instant now);

  void receive(serial::ByteSpan bytes, Instant now) override;
  void advance(Instant now) override;
  Instant due() const override;
  serial::Bytes take_output() override { return std::exchange(output_, {}); }
  int baud() const override { return baud_; }

  // For tests of faults: the status byte of its scans; a scanner that says nothing; one that repeats its last scan.
  void set_status(std::uint8_t status) { status_ = status; }
  void set_silent(bool silent) { silent_ = silent; }
  void set_frozen(bool frozen) { frozen_ = frozen; }
  const serial::sick::Config& config() const { return block_; }
  std::uint8_t mode() const { return mode_; }

 private:
  void obey_all(Instant now);
  void obey(serial::ByteSpan payload, Instant now);
  void change_mode(serial::ByteSpan arguments, Instant now);
  bool enter(std::uint8_t mode, serial::ByteSpan arguments);
  void change_variant(serial::ByteSpan arguments);
  void change_config(serial::ByteSpan block, Instant now);
  void answer(std::uint8_t id, serial::ByteSpan data) { reply(serial::sick::encode_reply(id, data)); }
  void reply(const serial::Bytes& telegram);
  serial::Bytes status_block() const;

  bool streaming() const;
  Duration turns(unsigned count) const;
  Duration scan_period() const;
  void schedule(Instant not_before);
  void capture(Instant now);

  SimulatedSickConfig options_;
  serial::sick::TelegramDecoder decoder_{serial::sick::Sender::host};
  std::uint64_t bad_checksums_ = 0;
  Instant last_byte_;
  serial::Bytes output_;

  int baud_;
  std::uint8_t mode_ = serial::sick::mode::on_request;
  serial::sick::Variant variant_;
  serial::sick::Config block_;
  unsigned mean_of_ = 1, first_ = 1, last_ = 0;  // of the running stream
  bool poll_ = false;

  Instant mirror_;       // some moment at which the mirror passed the middle of its field
  Instant capture_due_;  // of the next scan
  Instant line_free_;
  serial::Bytes telegram_;  // on its way; whole at send_due_
  Instant send_due_;
  std::optional<Instant> booted_, config_written_;
  int partial_ = 0;
  std::uint8_t scan_number_ = 0;
  std::uint8_t status_ = serial::sick::healthy_status;
  bool silent_ = false, frozen_ = false;
  serial::sick::Values last_values_;
};

}  // namespace devices
