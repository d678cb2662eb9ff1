#include "server/tools/simulated_public.hpp"

#include <array>
#include <cmath>

namespace tools {
namespace {

constexpr std::array names{"Ada", "Tomasz", "Mirela", "Class 7b", "Jonas", "Aylin", "Grace", "Noor", "Wim", "Chiara"};

}  // namespace

SimulatedPublic::SimulatedPublic(const robot::Museum& museum, const PublicConfig& config, std::uint64_t seed)
    : museum_(museum), config_(config), random_(seed), next_wish_(robot::from_seconds(5.0)) {}

robot::Requester SimulatedPublic::draw_requester() {
  const bool kiosk = random_.chance(config_.kiosk_share);
  return {names[random_.index(names.size())], kiosk ? robot::Channel::kiosk : robot::Channel::web,
          "visitor-" + std::to_string(ticket_)};
}

robot::Event SimulatedPublic::draw_wish() {
  const double dice = random_.uniform();
  if (dice < config_.tour_share && !museum_.tours.empty()) {
    return robot::StartTour{++ticket_, draw_requester(), museum_.tours[random_.index(museum_.tours.size())].id};
  }
  if (dice < config_.tour_share + config_.point_share || museum_.exhibits.empty()) {
    // A click anywhere on the free floor of the plan; the robot may have to say no.
    const auto& map = museum_.map;
    for (int tries = 0; tries < 100; ++tries) {
      const robot::Point p{map.origin().x + random_.uniform() * map.width() * map.resolution(),
                           map.origin().y + random_.uniform() * map.height() * map.resolution()};
      if (!robot::is_free(map.at_or(map.cell(p), robot::unknown_cell))) continue;
      return robot::RequestVisit{++ticket_, draw_requester(), robot::PointTarget{p, std::nullopt}};
    }
  }
  if (museum_.exhibits.empty()) return robot::Tick{};
  const auto& exhibit = museum_.exhibits[random_.index(museum_.exhibits.size())];
  return robot::RequestVisit{++ticket_, draw_requester(), robot::ExhibitTarget{exhibit.id, std::nullopt}};
}

std::vector<robot::Event> SimulatedPublic::wishes(robot::Time now) {
  std::vector<robot::Event> events;
  while (config_.requests_per_hour > 0.0 && now >= next_wish_) {
    const double pause = -std::log(1.0 - random_.uniform()) * 3600.0 / config_.requests_per_hour;
    next_wish_ = next_wish_ + robot::Seconds(pause);
    robot::Event wish = draw_wish();
    if (std::holds_alternative<robot::Tick>(wish)) continue;
    ++asked_;
    events.push_back(std::move(wish));
  }
  if (answer_at_ && now >= *answer_at_) {
    answer_at_.reset();
    events.push_back(robot::AnswerTour{++ticket_, answer_});
  }
  for (std::size_t i = 0; i < second_thoughts_.size();) {
    if (now < second_thoughts_[i].when) {
      ++i;
      continue;
    }
    events.push_back(robot::CancelRequest{++ticket_, second_thoughts_[i].id, second_thoughts_[i].session, false});
    second_thoughts_.erase(second_thoughts_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return events;
}

void SimulatedPublic::see(const robot::Output& output, robot::Time now) {
  if (const auto* status = std::get_if<robot::Status>(&output)) {
    const bool asking = status->activity == robot::Activity::asking;
    if (asking && !was_asking_ && random_.chance(0.7)) {  // otherwise nobody is at the screen
      answer_at_ = now + robot::Seconds(random_.uniform(1.0, 6.0));
      const double dice = random_.uniform();
      answer_ = dice < 0.3 ? robot::TourAnswer::more : robot::TourAnswer::move_on;
    }
    was_asking_ = asking;
    if (!asking) answer_at_.reset();
  } else if (const auto* changed = std::get_if<robot::RequestChanged>(&output)) {
    const auto& request = changed->request;
    const bool fresh = request.state == robot::RequestState::pending && request.asked == now && request.tour.empty();
    if (fresh && random_.chance(config_.cancel_share)) {
      second_thoughts_.push_back(
          {now + robot::Seconds(random_.uniform(5.0, 120.0)), request.id, request.requester.session});
    }
  }
}

}  // namespace tools
