#include "robot/localization/beam_reading.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "robot/localization/lost.hpp"
#include "tests/support/ascii_world.hpp"

namespace robot {
namespace {

using testing::draw_world;
using ::testing::ElementsAre;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A hall 5 m long with a wall in its middle that leaves a door, and unknown space on the right.
class BeamReading : public ::testing::Test {
 protected:
  LaserScan scan(std::vector<float> ranges) const { return {{}, LaserId::front, 0.0, 0.0, 30.0f, std::move(ranges)}; }
  ScanReading read(const Pose& from, std::vector<float> ranges) const {
    return reader.read(scan(std::move(ranges)), from, 0.02, 0.005);
  }
  testing::AsciiWorld world = draw_world(
      0.1,
      {"####################################################", "#.........................#........................?",
       "#.........................#........................?", "#...A.....................#........................?",
       "#.........................#............C...........?", "#..................................................?",
       "#..................................................?", "#..................................................?",
       "####################################################"});
  RayCaster caster{world.map};
  LikelihoodField field{world.map, {}};
  BeamReader reader{caster, field, {}};
};

TEST_F(BeamReading, SortsBeamsByWhatTheyMet) {
  const Pose from{world.at('A').x, world.at('A').y, 0.0};  // the wall's face is 2.15 m ahead
  const auto reading = read(from, {2.15f, 2.30f, 1.0f, 4.0f, nan, 30.0f, 0.0f});
  EXPECT_THAT(reading.kinds, ElementsAre(BeamKind::map, BeamKind::map, BeamKind::person, BeamKind::unexpected_far,
                                         BeamKind::no_return, BeamKind::no_return, BeamKind::no_return));
  EXPECT_NEAR(reading.expected[0], 2.15, 1e-5);
  const auto counts = count_beams(reading);
  EXPECT_EQ(counts.map, 2);
  EXPECT_EQ(counts.person, 1);
  EXPECT_EQ(counts.far, 1);
  EXPECT_EQ(counts.none, 3);
  EXPECT_NEAR(counts.far_share(), 1.0 / 3.0, 1e-9);
}

TEST_F(BeamReading, ABeamThatJustPassesAnEdgeContradictsNothing) {
  // At this heading the beam meets the wall's lower end by a hand's breadth, and the door is right beside.
  const double to_edge = std::atan2(0.4 - world.at('A').y, 2.6 - world.at('A').x);
  const Pose from{world.at('A').x, world.at('A').y, to_edge + 0.004};
  const auto reading = read(from, {4.0f});
  EXPECT_LT(reading.expected[0], 3.0f);
  EXPECT_THAT(reading.kinds, ElementsAre(BeamKind::map));
}

TEST_F(BeamReading, UnknownSpaceContradictsNothingAndIsCounted) {
  const Pose from{world.at('C').x, world.at('C').y, 0.0};
  const auto reading = read(from, {1.2f});
  EXPECT_THAT(reading.kinds, ElementsAre(BeamKind::map));
  EXPECT_EQ(reading.unknown, 1);
  EXPECT_EQ(count_beams(reading).map, 0);
}

TEST_F(BeamReading, TheDistanceFilterTakesOnlyWhatIsSurelyShort) {
  const auto beam = [&](float range) { return beams_of(scan({range}), {}).beams.front(); };
  std::vector<Pose> belief(20, Pose{world.at('A').x, world.at('A').y, 0.0});
  EXPECT_TRUE(reader.is_short(beam(1.0f), {}, belief));
  EXPECT_FALSE(reader.is_short(beam(2.1f), {}, belief));
  EXPECT_FALSE(reader.is_short(beam(4.0f), {}, belief));
  // One sample of twenty from which the wall would be just there: 95 % is not enough.
  belief[7].x += 1.15;
  EXPECT_FALSE(reader.is_short(beam(1.0f), {}, belief));
  EXPECT_FALSE(reader.is_short(beam(1.0f), {}, {}));
}

TEST(Lost, ACrowdIsNoReason) {
  LostJudge judge({});
  for (int i = 0; i < 100; ++i) judge.observe({.map = 4, .person = 170, .far = 0});
  EXPECT_FALSE(judge.lost());
  EXPECT_TRUE(judge.confirmed());
}

TEST(Lost, NorIsAnOpenDoorButImpossibleReadingsAre) {
  LostJudge judge({});
  for (int i = 0; i < 100; ++i) judge.observe({.map = 120, .person = 20, .far = 25});
  EXPECT_FALSE(judge.lost());
  int scans = 0;
  while (!judge.lost() && ++scans < 100) judge.observe({.map = 40, .person = 60, .far = 80});
  EXPECT_GT(scans, 5);
  EXPECT_LT(scans, 25);
}

TEST(Lost, OneBadScanIsForgiven) {
  LostJudge judge({});
  for (int i = 0; i < 50; ++i) {
    judge.observe({.map = 10, .far = 100});
    for (int k = 0; k < 3; ++k) judge.observe({.map = 150, .far = 2});
    EXPECT_FALSE(judge.lost());
  }
}

TEST(Lost, GoodScansBringItBack) {
  LostJudge judge({});
  for (int i = 0; i < 30; ++i) judge.observe({.map = 10, .far = 100});
  ASSERT_TRUE(judge.lost());
  for (int i = 0; i < 10; ++i) judge.observe({.map = 150, .far = 2});
  EXPECT_FALSE(judge.lost());
  judge.observe({.person = 180});
  EXPECT_FALSE(judge.lost());
}

}  // namespace
}  // namespace robot
