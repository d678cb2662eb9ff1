#include "robot/interaction/words.hpp"

#include <gtest/gtest.h>

namespace robot {
namespace {

Museum museum_with_engine() {
  Museum museum;
  Exhibit engine;
  engine.id = "beam-engine";
  engine.title = {{"en", "Beam engine"}, {"de", "Dampfmaschine"}};
  engine.to = {{"en", "to the beam engine"}, {"de", "zur Dampfmaschine"}};
  museum.exhibits.push_back(engine);
  museum.tours.push_back(
      {.id = "steam", .title = {{"en", "Steam"}, {"de", "Dampf"}}, .summary = {}, .exhibits = {"beam-engine"}});
  return museum;
}

TEST(Words, SayWhereItDrivesAndForWhom) {
  Status status;
  status.activity = Activity::driving;
  status.exhibit = "beam-engine";
  status.requester = "Mirela";
  status.distance_to_go = 14.2;
  status.seconds_to_go = 41.0;
  const Museum museum = museum_with_engine();
  EXPECT_EQ(status_sentence(status, museum).at("en"), "I am on my way to the beam engine.");
  EXPECT_EQ(status_sentence(status, museum).at("de"), "Ich bin unterwegs zur Dampfmaschine.");
  EXPECT_EQ(status_detail(status, museum).at("en"), "For Mirela. 14 m to go, about 40 s.");
  EXPECT_EQ(status_detail(status, museum).at("de"), "Für Mirela. Noch 14 m, etwa 40 s.");
}

TEST(Words, QuoteTheTitleWhereNoPhraseIsGiven) {
  Status status;
  status.activity = Activity::explaining;
  status.exhibit = "beam-engine";
  EXPECT_EQ(status_sentence(status, museum_with_engine()).at("de"), "Ich erzähle euch etwas über „Dampfmaschine“.");
}

TEST(Words, CountThePeopleInTheWay) {
  Status status;
  status.activity = Activity::waiting;
  status.why = Why::people_in_the_way;
  status.people_near = 3;
  EXPECT_EQ(status_sentence(status, {}).at("en"), "I am waiting for three people to make way.");
  status.people_near = 1;
  EXPECT_EQ(status_sentence(status, {}).at("de"), "Ich warte, bis mich jemand durchlässt.");
}

TEST(Words, TellTheTourAndItsStop) {
  Status status;
  status.activity = Activity::driving;
  status.exhibit = "beam-engine";
  status.tour = "steam";
  status.stop_number = 1;
  status.stop_count = 4;
  EXPECT_EQ(status_detail(status, museum_with_engine()).at("en"), "Tour “Steam”, stop 1 of 4.");
}

TEST(Words, EveryActivityHasASentenceInBothLanguages) {
  for (int activity = 0; activity <= static_cast<int>(Activity::faulted); ++activity) {
    for (int why = 0; why <= static_cast<int>(Why::recording); ++why) {
      Status status;
      status.activity = static_cast<Activity>(activity);
      status.why = static_cast<Why>(why);
      const Text text = status_sentence(status, {});
      EXPECT_FALSE(text.at("en").empty());
      EXPECT_FALSE(text.at("de").empty());
    }
  }
}

TEST(Words, SpeakDurationsAsPeopleDo) {
  EXPECT_EQ(spoken_duration(41).at("en"), "about 40 s");
  EXPECT_EQ(spoken_duration(250).at("de"), "4 min");
  EXPECT_EQ(spoken_duration(-1).at("en"), "about 5 s");
}

}  // namespace
}  // namespace robot
