#include "server/devices/simulated_hardware.hpp"

#include <array>
#include <cstdlib>
#include <system_error>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

namespace devices {
namespace asio = boost::asio;
namespace fs = std::filesystem;
using robot::Device;
using robot::LaserId;
using robot::simulation::World;

namespace {

constexpr auto step = 20ms;       // the world goes on when no device asks
constexpr auto most_behind = 1s;  // after a longer pause it does not catch up

robot::simulation::WorldConfig on_demand(robot::simulation::WorldConfig config) {
  config.laser_period = config.base_period = robot::Seconds(0);
  return config;
}

fs::path make_folder() {
  std::string name = (fs::temp_directory_path() / "docent-lines-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::system_error(errno, std::generic_category(), "cannot make a folder for simulated lines");
  }
  return name;
}

constexpr std::array<const char*, 3> names = {"base", "laser-front", "laser-rear"};

}  // namespace

struct SimulatedHardware::State : std::enable_shared_from_this<State> {
  State(asio::any_io_executor where, const robot::Museum& museum, const robot::Body& body,
        const robot::simulation::WorldConfig& config, std::uint64_t seed)
      : executor(std::move(where)),
        world(museum, body, on_demand(config), seed),
        zero(std::chrono::steady_clock::now()),
        timer(executor),
        folder(make_folder()) {}

  ~State() {
    for (auto& line : lines) line.reset();
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  // The world, brought to the present.
  World& present() {
    const Instant now = std::chrono::steady_clock::now();
    const auto age = now - zero - world.now().time_since_epoch();
    if (age > most_behind) zero += std::chrono::duration_cast<Duration>(age);
    world.advance(robot::Time(now - zero));
    return world;
  }

  void add(Device device, std::shared_ptr<SimulatedDevice> simulated) {
    const auto index = static_cast<std::size_t>(device);
    lines[index] = std::make_unique<SimulatedLine>(executor, std::move(simulated), folder / names[index]);
  }

  void add_base() {
    SimulatedP2osConfig config;
    config.drive = [this](robot::Twist twist) { present().drive_to(twist); };
    config.enable_motors = [this](bool on) { present().enable_motors(on); };
    config.odometry = [this] { return present().odometry(); };
    config.state = [this] { return present().base(); };
    config.sonars = [this] { return present().sonars(); };
    add(Device::base, std::make_shared<SimulatedP2os>(std::move(config), zero));
    lines[0]->tap(
        {.sent = {}, .received = [this](serial::ByteSpan bytes, Instant now) { probe.base_received(bytes, now); }});
  }

  void add_laser(Device device, LaserId laser, Instant switched_on) {
    SimulatedSickConfig config;
    config.scan = [this, laser] { return present().scan(laser); };
    add(device, std::make_shared<SimulatedSick>(std::move(config), switched_on));
  }

  void run() {
    timer.expires_after(step);
    timer.async_wait([weak = weak_from_this()](boost::system::error_code error) {
      const auto self = weak.lock();
      if (error || !self) return;
      self->present();
      self->run();
    });
  }

  SimulatedLine* line(Device device) { return lines[static_cast<std::size_t>(device)].get(); }

  asio::any_io_executor executor;
  World world;
  Instant zero;  // when the world began, on the machine's clock
  asio::steady_timer timer;
  fs::path folder;
  LatencyProbe probe;
  std::array<std::unique_ptr<SimulatedLine>, 3> lines;
};

SimulatedHardware::SimulatedHardware(asio::any_io_executor executor, const robot::Museum& museum,
                                     const robot::Body& body, robot::simulation::WorldConfig world, std::uint64_t seed)
    : state_(std::make_shared<State>(std::move(executor), museum, body, world, seed)) {
  State& state = *state_;
  state.add_base();
  if (body.lasers.size() > 0) {
    state.add_laser(Device::laser_front, LaserId::front, state.zero);
    state.line(Device::laser_front)
        ->tap({.sent = [&state](serial::ByteSpan, Instant now) { state.probe.scan_sent(now); }, .received = {}});
  }
  // Two mirrors are never in step.
  if (body.lasers.size() > 1) state.add_laser(Device::laser_rear, LaserId::rear, state.zero + 5ms);
  asio::post(state.executor, [keep = state_] { keep->run(); });
}

SimulatedHardware::~SimulatedHardware() { state_->timer.cancel(); }

std::string SimulatedHardware::path(Device device) const {
  return (state_->folder / names[static_cast<std::size_t>(device)]).string();
}

std::vector<std::string> SimulatedHardware::paths() const {
  std::vector<std::string> out;
  for (const Device device : {Device::base, Device::laser_front, Device::laser_rear}) {
    if (state_->line(device) != nullptr) out.push_back(path(device));
  }
  return out;
}

void SimulatedHardware::unplug(Device device) {
  asio::post(state_->executor, [state = state_, device] {
    if (auto* line = state->line(device)) line->unplug();
  });
}

void SimulatedHardware::plug(Device device) {
  asio::post(state_->executor, [state = state_, device] {
    if (auto* line = state->line(device)) line->plug();
  });
}

void SimulatedHardware::damage(Device device, SimulatedLine::Damage kind, double share) {
  asio::post(state_->executor, [state = state_, device, kind, share] {
    if (auto* line = state->line(device)) line->damage(kind, share);
  });
}

void SimulatedHardware::with_world(std::function<void(World&)> act) {
  asio::post(state_->executor, [state = state_, act = std::move(act)] { act(state->present()); });
}

void SimulatedHardware::with_latency(std::function<void(const LatencyProbe&)> act) {
  asio::post(state_->executor, [state = state_, act = std::move(act)] { act(state->probe); });
}

}  // namespace devices
