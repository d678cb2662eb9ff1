// The robot and the simulated world in one closed loop, for tests of the whole core.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "robot/robot.hpp"
#include "robot/simulation/world.hpp"

namespace robot::testing {

class Rehearsal {
 public:
  Rehearsal(const Museum& museum, Config config, simulation::WorldConfig world, std::uint64_t seed)
      : world_(museum, config.body, world, seed), robot_(museum, config) {}

  // Every input that the robot got and every output that it gave, in order.
  std::function<void(const Input&, const std::vector<Output>&)> watch;

  // Sensors that do not get through: return true for what the robot must not see.
  std::function<bool(const Event&)> lost;

  std::vector<Output> tell(Event event) { return feed({world_.now(), std::move(event)}); }

  void run(Seconds duration) {
    const Time end = world_.now() + duration;
    while (world_.now() < end) {
      for (const Input& input : world_.advance(world_.now() + Seconds(0.05))) {
        if (!lost || !lost(input.event)) feed({world_.now(), input.event});
      }
      feed({world_.now(), Tick{}});
    }
  }

  // Runs until the condition holds, at most so long; whether it came to hold.
  bool run_until(const std::function<bool()>& condition, Seconds at_most) {
    for (double t = 0.0; t < at_most.count() && !condition(); t += 0.1) run(Seconds(0.1));
    return condition();
  }

  simulation::World& world() { return world_; }
  // The newest of each that the robot said.
  Status status;
  PoseEstimate pose;
  WheelCommand command;
  std::vector<Request> requests;  // newest state of each, in order of first appearance
  std::vector<Speech> speeches;
  std::vector<Answer> answers;

  const Request* request(RequestId id) const {
    for (const Request& request : requests) {
      if (request.id == id) return &request;
    }
    return nullptr;
  }

 private:
  std::vector<Output> feed(Input input) {
    std::vector<Output> outputs = robot_.handle(input);
    for (const Output& output : outputs) note(output);
    if (watch) watch(input, outputs);
    return outputs;
  }

  void note(const Output& output) {
    if (const auto* c = std::get_if<WheelCommand>(&output)) world_.command(command = *c);
    if (const auto* m = std::get_if<EnableMotors>(&output)) world_.enable_motors(m->on);
    if (const auto* s = std::get_if<Status>(&output)) status = *s;
    if (const auto* p = std::get_if<PoseEstimate>(&output)) pose = *p;
    if (const auto* a = std::get_if<Answer>(&output)) answers.push_back(*a);
    if (const auto* s = std::get_if<Speech>(&output)) speeches.push_back(*s), world_.hear(*s);
    if (const auto* r = std::get_if<RequestChanged>(&output)) {
      for (Request& known : requests) {
        if (known.id == r->request.id) return void(known = r->request);
      }
      requests.push_back(r->request);
    }
  }

  simulation::World world_;
  Robot robot_;
};

}  // namespace robot::testing
