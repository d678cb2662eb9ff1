// What a simulated deployment is judged by, like the tables at the end of the papers (RHINO table 6, MINERVA table 4):
// way, speed, requests, contacts, how well the robot knew where it was, and how people were treated.
#pragma once

#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "robot/outputs.hpp"
#include "robot/simulation/world.hpp"

namespace tools {

class SimulationStatistics {
 public:
  // After each advance of the world.
  void see_truth(robot::Time now, const robot::Pose& pose, robot::Twist twist);
  // Each output of the robot.
  void see(const robot::Output& output, robot::Time now);

  // The report without what only the caller knows (factor over real time). open_for: requests that wait longer than
  // this at the end count as not fulfilled, younger ones not at all.
  nlohmann::json report(const robot::simulation::World& world, robot::Seconds open_for) const;

 private:
  struct Sample {
    robot::Time time;
    robot::Pose pose;
  };
  void judge(const robot::PoseEstimate& estimate);
  void see_status(const robot::Status& status, robot::Time now);
  nlohmann::json requests(robot::Time now, robot::Seconds open_for) const;

  std::deque<Sample> truth_;  // the last second
  robot::Pose last_;
  bool started_ = false, moving_ = false;
  double distance_ = 0.0, moving_seconds_ = 0.0, fastest_ = 0.0;
  robot::Time last_time_{};
  int stops_ = 0;
  std::vector<float> errors_, turns_;  // m, rad
  double lost_seconds_ = 0.0;
  double wrong_seconds_ = 0.0;  // of the present spell of being wrong without saying so
  int lost_unnoticed_ = 0;
  robot::Time last_estimate_{};
  std::map<robot::RequestId, robot::Request> requests_;
  std::map<robot::Refusal, int> refused_;
  int exhibits_ = 0, cut_short_ = 0;
  std::map<robot::Cue, int> cues_;
  std::map<robot::GateReason, double> gated_;
  std::map<robot::Activity, double> activity_seconds_;
  robot::Activity activity_ = robot::Activity::starting;
  robot::Time activity_since_{}, waiting_since_{};
  std::vector<double> waits_;  // s
  std::map<std::string, int> notes_;
};

}  // namespace tools
