#include "robot/tasks/guide.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace robot {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Exhibits a, b, c stand at 10, 20 and 30 m along a line; home is at 0.
Museum line_museum() {
  Museum museum;
  museum.map = OccupancyGrid(100, 20, 0.5, {-5, -5}, free_cell);
  int number = 0;
  for (const std::string id : {"a", "b", "c"}) {
    Exhibit exhibit;
    exhibit.id = id;
    exhibit.number = ++number;
    exhibit.title = {{"en", id}};
    exhibit.viewpoints = {{{10.0 * number, 0.0, 0.0}}};
    exhibit.narrations = {{.text = {{"en", "first"}}, .picture = {}, .duration = Seconds(20)},
                          {.text = {{"en", "second"}}, .picture = {}, .duration = Seconds(10)}};
    museum.exhibits.push_back(exhibit);
  }
  museum.tours = {{.id = "all", .title = {{"en", "All"}}, .summary = {}, .exhibits = {"b", "a", "c"}}};
  return museum;
}

class GuideTest : public testing::Test {
 protected:
  Museum museum_ = line_museum();
  Guide guide_{museum_,
               {},
               [](Point p) { return p.x > 40 ? Refusal::off_the_map : Refusal::none; },
               [this](const Target& a, const Target& b) { return distance(place(a), place(b)); }};
  Time now_ = from_seconds(100);
  Progress progress_;
  std::vector<Output> out_;
  std::vector<std::string> log_;  // "3 fulfilled", "says make_way"
  std::map<RequestId, Request> requests_;
  Answer answer_;

  Point place(const Target& target) const {
    if (const auto* at = std::get_if<PointTarget>(&target)) return at->point;
    return find_exhibit(museum_, std::get<ExhibitTarget>(target).exhibit)->viewpoints.front().pose.position();
  }

  void read() {
    for (const Output& output : out_) {
      if (const auto* change = std::get_if<RequestChanged>(&output)) requests_[change->request.id] = change->request;
      if (const auto* answer = std::get_if<Answer>(&output)) answer_ = *answer;
      if (const auto* speech = std::get_if<Speech>(&output)) {
        const char* const cues[] = {"narration", "greeting", "make_way", "horn", "arrived", "farewell"};
        log_.push_back(std::string(cues[static_cast<int>(speech->cue)]) + " " + speech->exhibit);
      }
      if (const auto* visit = std::get_if<VisitEnded>(&output))
        log_.push_back("left " + visit->exhibit + (visit->complete ? "" : " early"));
    }
    out_.clear();
  }

  RequestId ask(const std::string& exhibit, const std::string& session = "s") {
    guide_.handle(RequestVisit{.ticket = 7,
                               .requester = {.name = "Ada", .channel = Channel::web, .session = session},
                               .target = ExhibitTarget{exhibit, {}}},
                  now_, out_);
    read();
    return answer_.requests.empty() ? 0 : answer_.requests.front();
  }
  template <typename T>
  Refusal tell(const T& wish) {
    guide_.handle(wish, now_, out_);
    read();
    return answer_.refusal;
  }
  void wait(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.5) {
      now_ = now_ + Seconds(0.5);
      guide_.tick(progress_, now_, out_);
      read();
    }
  }
  void drive_there() {
    wait(1);
    ASSERT_TRUE(guide_.goal());
    progress_.map_from_base = guide_.goal()->places.front();
    progress_.arrived = true;
    wait(1);
    progress_.arrived = false;
  }
  RequestState state(RequestId id) { return requests_.at(id).state; }
  Status status() {
    Status s;
    guide_.describe(s, now_);
    return s;
  }
};

TEST_F(GuideTest, DrivesExplainsAndFulfils) {
  const RequestId id = ask("b");
  EXPECT_EQ(state(id), RequestState::pending);
  EXPECT_NEAR(requests_.at(id).eta_seconds, 20.0 / 0.4, 1.0);  // known before it moves
  wait(1);
  EXPECT_EQ(state(id), RequestState::active);
  EXPECT_EQ(status().activity, Activity::driving);
  EXPECT_EQ(status().requester, "Ada");
  drive_there();
  EXPECT_EQ(status().activity, Activity::explaining);
  EXPECT_FALSE(guide_.goal());
  wait(21);
  EXPECT_EQ(status().activity, Activity::asking);
  wait(10);
  EXPECT_EQ(state(id), RequestState::fulfilled);
  EXPECT_THAT(log_, ElementsAre("narration b", "left b"));
}

TEST_F(GuideTest, VisitsAnExhibitAskedByThreeOnce) {
  const RequestId first = ask("a", "s1"), second = ask("a", "s2"), third = ask("a", "s3");
  drive_there();
  wait(40);
  for (const RequestId id : {first, second, third}) EXPECT_EQ(state(id), RequestState::fulfilled);
  EXPECT_THAT(log_, ElementsAre("narration a", "left a"));
}

TEST_F(GuideTest, OrdersByLeastTravelFromHere) {
  const RequestId c = ask("c"), a = ask("a"), b = ask("b");
  wait(1);
  EXPECT_EQ(requests_.at(a).position, 1);
  EXPECT_EQ(requests_.at(b).position, 2);
  EXPECT_EQ(requests_.at(c).position, 3);
  EXPECT_GT(requests_.at(c).eta_seconds, requests_.at(b).eta_seconds);
}

TEST_F(GuideTest, KeepsTheToursOrder) {
  EXPECT_EQ(
      tell(StartTour{
          .ticket = 1, .requester = {.name = "Class 7b", .channel = Channel::kiosk, .session = "k"}, .tour = "all"}),
      Refusal::none);
  for (int stop = 0; stop < 3; ++stop) {
    drive_there();
    EXPECT_EQ(status().stop_number, stop + 1);
    EXPECT_EQ(status().stop_count, 3);
    EXPECT_EQ(tell(AnswerTour{.ticket = 2, .answer = TourAnswer::move_on}), Refusal::none);
  }
  EXPECT_THAT(log_, ElementsAre("narration b", "left b", "narration a", "left a", "narration c", "left c"));
}

TEST_F(GuideTest, TellsMoreWhenAsked) {
  ask("a");
  drive_there();
  wait(21);
  EXPECT_EQ(tell(AnswerTour{.ticket = 1, .answer = TourAnswer::more}), Refusal::none);
  EXPECT_EQ(tell(AnswerTour{.ticket = 1, .answer = TourAnswer::more}),
            Refusal::nothing_to_answer);  // there are only two
  wait(11);
  EXPECT_THAT(log_, ElementsAre("narration a", "narration a", "left a"));
}

TEST_F(GuideTest, EndingATourCancelsTheRestOfIt) {
  tell(StartTour{.ticket = 1, .requester = {.name = "Bo", .channel = Channel::kiosk, .session = "k"}, .tour = "all"});
  const auto ids = answer_.requests;
  drive_there();
  EXPECT_EQ(tell(AnswerTour{.ticket = 2, .answer = TourAnswer::end_tour}), Refusal::none);
  EXPECT_EQ(state(ids[0]), RequestState::fulfilled);
  EXPECT_EQ(state(ids[1]), RequestState::cancelled);
  EXPECT_EQ(state(ids[2]), RequestState::cancelled);
  wait(1);
  EXPECT_EQ(status().activity, Activity::idle);
}

TEST_F(GuideTest, AsksPeopleInTheWayThenHornsThenTriesAnotherFirst) {
  const RequestId a = ask("a"), b = ask("b");
  wait(1);
  progress_.blocked = true;
  progress_.people_ahead = progress_.people_near = 2;
  progress_.goal_distance = 10.0;
  wait(20);
  EXPECT_THAT(log_, ElementsAre("make_way ", "horn "));
  EXPECT_EQ(status().activity, Activity::waiting);
  wait(75);
  EXPECT_EQ(state(a), RequestState::pending);
  EXPECT_EQ(state(b), RequestState::active);
}

TEST_F(GuideTest, ExplainsACrowdedExhibitFromNearBy) {
  ask("a");
  wait(1);
  progress_.blocked = true;
  progress_.goal_distance = 1.0;
  wait(8);
  EXPECT_EQ(status().activity, Activity::explaining);
}

TEST_F(GuideTest, GivesUpWhereThereIsNoWay) {
  const RequestId id = ask("a");
  wait(1);
  progress_.reachable = false;
  wait(60);
  EXPECT_EQ(state(id), RequestState::failed);
  EXPECT_EQ(requests_.at(id).reason, "There is no way there at the moment.");
}

TEST_F(GuideTest, GoesHomeWhenThereIsNothingToDo) {
  ask("a");
  drive_there();
  wait(45);
  EXPECT_EQ(status().activity, Activity::homing);
  progress_.map_from_base = museum_.home;
  progress_.arrived = true;
  wait(1);
  EXPECT_EQ(status().activity, Activity::idle);
}

TEST_F(GuideTest, RefusesWithAReason) {
  EXPECT_EQ(ask("nowhere"), 0u);
  EXPECT_EQ(answer_.refusal, Refusal::unknown_exhibit);
  EXPECT_EQ(answer_.ticket, 7u);
  const auto point = [&](double x, double y) {
    return tell(RequestVisit{.ticket = 1, .requester = {}, .target = PointTarget{{x, y}, {}}});
  };
  EXPECT_EQ(point(std::numeric_limits<double>::quiet_NaN(), 0), Refusal::not_finite);
  EXPECT_EQ(point(50, 0), Refusal::off_the_map);
  EXPECT_EQ(tell(RequestVisit{.ticket = 1, .requester = {}, .target = ExhibitTarget{"a", 4}}),
            Refusal::unknown_viewpoint);
  EXPECT_EQ(tell(StartTour{.ticket = 1, .requester = {}, .tour = "none"}), Refusal::unknown_tour);
  EXPECT_EQ(tell(AnswerTour{.ticket = 1, .answer = TourAnswer::more}), Refusal::nothing_to_answer);
  EXPECT_EQ(tell(CancelRequest{.ticket = 1, .id = 99, .session = {}, .staff = true}), Refusal::unknown_request);
}

TEST_F(GuideTest, OnlyTheRequesterOrStaffMayCancel) {
  const RequestId id = ask("a", "ada");
  EXPECT_EQ(tell(CancelRequest{.ticket = 1, .id = id, .session = "eve"}), Refusal::not_yours);
  EXPECT_EQ(tell(CancelRequest{.ticket = 1, .id = id, .session = "ada"}), Refusal::none);
  EXPECT_EQ(state(id), RequestState::cancelled);
  EXPECT_EQ(tell(CancelRequest{.ticket = 1, .id = id, .session = "ada"}), Refusal::already_over);
}

TEST_F(GuideTest, CancellingTheVisitUnderWayLeavesIt) {
  const RequestId id = ask("a", "ada");
  drive_there();
  EXPECT_EQ(tell(CancelRequest{.ticket = 1, .id = id, .session = "ada"}), Refusal::none);
  wait(1);
  EXPECT_EQ(status().activity, Activity::idle);
  EXPECT_THAT(log_, ElementsAre("narration a", "left a early"));
}

TEST_F(GuideTest, OnePersonMayNotFillTheQueue) {
  for (int i = 0; i < 5; ++i)
    tell(RequestVisit{.ticket = 1,
                      .requester = {.name = "", .channel = Channel::web, .session = "x"},
                      .target = PointTarget{{i * 1.0, 1}, {}}});
  EXPECT_EQ(ask("a", "x"), 0u);
  EXPECT_EQ(answer_.refusal, Refusal::queue_full);
  EXPECT_NE(ask("a", "y"), 0u);
}

TEST_F(GuideTest, RemembersOpenRequestsOverARestart) {
  Remember memory;
  memory.next_id = 42;
  memory.open = {{.id = 40,
                  .requester = {.name = "Ada", .channel = Channel::web, .session = "s"},
                  .target = ExhibitTarget{"c", {}}},
                 {.id = 41, .requester = {}, .target = ExhibitTarget{"gone", {}}}};
  tell(memory);
  EXPECT_EQ(state(40), RequestState::pending);
  EXPECT_EQ(state(41), RequestState::failed);
  EXPECT_EQ(ask("a"), 42u);
  drive_there();
  EXPECT_EQ(status().exhibit, "a");
}

}  // namespace
}  // namespace robot
