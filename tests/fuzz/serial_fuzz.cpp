// Any bytes on any serial line: nothing crashes, what is understood means the same after a round over the wire, and the
// simulated devices answer or keep silent.
#include <cstdlib>

#include "protocols/serial/p2os_base.hpp"
#include "protocols/serial/sick_scan.hpp"
#include "server/devices/simulated_p2os.hpp"
#include "server/devices/simulated_sick.hpp"

namespace {

using serial::ByteSpan;

void require(bool held) {
  if (!held) std::abort();
}

// In pieces whose size the input chooses.
template <typename Decoder, typename Take>
void feed_in_pieces(ByteSpan bytes, Decoder& decoder, const Take& take) {
  const std::size_t piece = bytes.empty() ? 1 : 1 + bytes.front();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    decoder.feed(bytes.first(std::min(piece, bytes.size())));
    while (const auto item = decoder.next()) take(*item);
  }
  decoder.line_fell_silent();
  while (const auto item = decoder.next()) take(*item);
}

void read_laser(ByteSpan bytes) {
  using namespace serial::sick;  // NOLINT: a fuzz target
  TelegramDecoder decoder(Sender::sensor);
  feed_in_pieces(bytes, decoder, [](const Item& item) {
    if (item.kind != Item::telegram) return;
    const auto reply = parse_reply(item.payload);
    require(reply.has_value());
    parse_variant_reply(reply->data);
    parse_status(reply->data);
    parse_config(reply->data);
    const auto values = parse_values(item.payload);
    if (!values) return;
    TelegramDecoder again(Sender::sensor);
    again.feed(encode_values(*values));
    const auto copy = again.next();
    require(copy && parse_values(copy->payload) == values);
    to_laser_scan(*values, {}, robot::LaserId::front);
  });
  require(decoder.counts().skipped_bytes <= bytes.size());
}

void read_base(ByteSpan bytes) {
  using namespace serial::p2os;  // NOLINT: a fuzz target
  PacketDecoder decoder;
  OdometryTracker tracker(model_of("p3dx-sh"));
  feed_in_pieces(bytes, decoder, [&](ByteSpan body) {
    parse_config(body);
    parse_identity(body);
    parse_encoders(body);
    parse_command(body);
    const auto sip = parse_sip(body);
    if (!sip) return;
    require(robot::is_finite(tracker.update(*sip).odom_from_base));
    base_state(*sip);
    sonar_scan(*sip, model_of("p3at"));
  });
}

// A host that talks nonsense to a device, over some time.
void talk_to(devices::SimulatedDevice& device, ByteSpan bytes) {
  devices::Instant now{};
  const std::size_t piece = bytes.empty() ? 1 : 1 + bytes.front();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(piece, bytes.size()))) {
    device.receive(bytes.first(std::min(piece, bytes.size())), now);
    now += std::chrono::milliseconds(bytes.front());
    for (int i = 0; i < 20 && device.due() <= now; ++i) device.advance(now);
    require(device.take_output().size() < 64 * 1024);
  }
}

void talk_to_laser(ByteSpan bytes) {
  devices::SimulatedSickConfig config;
  config.scan = [] { return robot::LaserScan{{}, {}, -1.5, 0.0174, 32.0f, std::vector<float>(181, 2.0f)}; };
  devices::SimulatedSick laser(config, {});
  talk_to(laser, bytes);
}

void talk_to_base(ByteSpan bytes) {
  devices::SimulatedP2osConfig config;
  robot::Twist twist;
  config.drive = [&](robot::Twist wanted) { twist = wanted; };
  config.enable_motors = [](bool) {};
  config.odometry = [&] { return robot::Odometry{{}, {}, twist}; };
  config.state = [] { return robot::BaseState{.time = {}, .motors_enabled = true}; };
  config.sonars = [] { return robot::SonarScan{{}, {{1, 1.0f}}}; };
  devices::SimulatedP2os base(config, {});
  for (const int step : {0, 1, 2, 1}) base.receive(serial::p2os::encode(static_cast<serial::p2os::Command>(step)), {});
  talk_to(base, bytes);
  require(std::abs(twist.linear) <= 2.2 && std::abs(twist.angular) <= 10.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteSpan bytes(data, size);
  read_laser(bytes);
  read_base(bytes);
  talk_to_laser(bytes);
  talk_to_base(bytes);
  return 0;
}

// What inputs without coverage guidance are made of: telegrams and packets, to be cut and joined.
std::vector<serial::Bytes> fuzz_seeds() {
  using serial::p2os::Command;
  using serial::p2os::encode;
  serial::sick::Values values;
  values.values.assign(181, 1234);
  serial::p2os::Sip sip;
  sip.sonars = {{1, 1000}, {7, 5000}};
  std::vector<serial::Bytes> seeds = {serial::sick::encode_values(values),
                                      serial::p2os::encode_sip(sip),
                                      serial::sick::install_mode(),
                                      serial::sick::set_config({}),
                                      serial::sick::mean_mode(3),
                                      serial::sick::sub_range_mode(5, 90),
                                      serial::sick::poll_all(),
                                      serial::sick::encode_status({}),
                                      encode(Command::say, "la"),
                                      encode(Command::move, -300),
                                      encode(Command::head, 200),
                                      serial::p2os::encode_vel2(90, -90),
                                      encode(Command::hostbaud, 3),
                                      encode(Command::config, 1),
                                      encode(Command::encoder, 2),
                                      serial::p2os::encode_config({}),
                                      serial::p2os::encode_identity({"a", "b", "c"})};
  for (const auto mode : {0x24, 0x25, 0x2A, 0x40, 0x48})
    seeds.push_back(serial::sick::set_mode(static_cast<std::uint8_t>(mode)));
  for (const auto resolution : {25u, 50u, 100u}) seeds.push_back(serial::sick::set_variant({100, resolution}));
  return seeds;
}
