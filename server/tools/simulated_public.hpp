// People who use the robot in a simulation: requests from the web and the kiosk, tours, answers to "more, or move on?",
// second thoughts. Seeded; inputs for the robot come out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/geometry/random.hpp"
#include "robot/inputs.hpp"
#include "robot/museum.hpp"
#include "robot/outputs.hpp"

namespace tools {

struct PublicConfig {
  double requests_per_hour = 50.0;
  double tour_share = 0.04;    // of the wishes
  double point_share = 0.08;   // places on the map instead of exhibits
  double kiosk_share = 0.3;    // the rest comes from the web
  double cancel_share = 0.03;  // of those accepted
};

class SimulatedPublic {
 public:
  SimulatedPublic(const robot::Museum& museum, const PublicConfig& config, std::uint64_t seed);

  // What people do now. Call about 20 times a second.
  std::vector<robot::Event> wishes(robot::Time now);
  // They see what the robot says.
  void see(const robot::Output& output, robot::Time now);

  int asked() const { return asked_; }

 private:
  struct SecondThought {
    robot::Time when;
    robot::RequestId id;
    std::string session;
  };
  robot::Event draw_wish();
  robot::Requester draw_requester();

  const robot::Museum& museum_;
  PublicConfig config_;
  robot::Random random_;
  robot::Ticket ticket_ = 0;
  int asked_ = 0;
  robot::Time next_wish_{};
  std::optional<robot::Time> answer_at_;
  robot::TourAnswer answer_ = robot::TourAnswer::move_on;
  bool was_asking_ = false;
  std::vector<SecondThought> second_thoughts_;
};

}  // namespace tools
