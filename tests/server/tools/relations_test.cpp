#include "server/tools/relations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "robot/geometry/random.hpp"

namespace tools {
namespace {

// A drive on a curved way with a pose every tenth of a second, times not quite even.
files::PoseTrack drive() {
  robot::Random random(7);
  files::PoseTrack track;
  robot::Pose pose;
  for (double time = 0.0; time < 120.0; time += 0.1 + 0.02 * random.uniform()) {
    track.push_back({time, pose});
    pose = pose * robot::arc({0.5, 0.8 * std::sin(0.3 * time) + 0.2 * std::sin(1.7 * time)}, 0.1);
  }
  return track;
}

std::vector<files::Relation> relations_of(const files::PoseTrack& track, double offset) {
  std::vector<files::Relation> relations;
  for (std::size_t i = 0; i + 30 < track.size(); i += 7) {
    const auto& a = track[i];
    const auto& b = track[i + 25];
    relations.push_back({a.time + offset, b.time + offset, robot::relative(a.pose, b.pose)});
    relations.push_back({b.time + offset, a.time + offset, robot::relative(b.pose, a.pose)});
  }
  return relations;
}

TEST(Relations, TruePosesScoreZero) {
  const auto track = drive();
  const auto relations = relations_of(track, 100.0);
  const auto score = score_relations(relations, track, track, 100.0);
  EXPECT_EQ(score.matched, static_cast<int>(relations.size()));
  EXPECT_NEAR(score.translation_mean_m, 0.0, 1e-9);
  EXPECT_NEAR(score.rotation_mean_deg, 0.0, 1e-9);
}

TEST(Relations, AnotherFrameDoesNotMatterButStretchedPosesDo) {
  const auto track = drive();
  auto moved = track, stretched = track;
  for (auto& timed : moved) timed.pose = robot::Pose{5.0, -3.0, 1.0} * timed.pose;
  for (auto& timed : stretched) timed.pose.x *= 1.1, timed.pose.y *= 1.1;
  const auto relations = relations_of(track, 0.0);
  EXPECT_NEAR(score_relations(relations, moved, track, 0.0).translation_mean_m, 0.0, 1e-9);
  const auto score = score_relations(relations, stretched, track, 0.0);
  EXPECT_NEAR(score.translation_mean_m, 0.1 * 1.25, 0.05) << "a tenth of the way between the two poses";
  EXPECT_NEAR(score.rotation_mean_deg, 0.0, 1e-9);
}

TEST(Relations, OdometryCarriesWhereNoEstimateIsNear) {
  const auto odometry = drive();
  files::PoseTrack sparse;
  for (std::size_t i = 0; i < odometry.size(); i += 20) sparse.push_back(odometry[i]);
  const auto score = score_relations(relations_of(odometry, 0.0), sparse, odometry, 0.0);
  EXPECT_LT(score.translation_mean_m, 0.05);
  EXPECT_FALSE(carried_pose(sparse, odometry, 500.0)) << "far beyond what anybody knows";
  EXPECT_FALSE(carried_pose({}, odometry, 5.0));
}

TEST(Relations, ClockOffsetIsFoundFromTheStepsAlone) {
  const auto track = drive();
  const auto found = find_clock_offset(relations_of(track, 1234.5), track, {0.0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 1234.5, 0.02);
}

TEST(Relations, LikelyOffsetIsTakenWhenItFits) {
  const auto track = drive();
  EXPECT_EQ(find_clock_offset(relations_of(track, 50.0), track, {0.0, 50.0}), 50.0);
}

TEST(Relations, RelationsOfAnotherDriveFindNoOffset) {
  auto other = drive();
  robot::Pose pose;
  robot::Random random(3);
  for (auto& timed : other) {
    timed.pose = pose;
    pose = pose * robot::Pose{0.2, 0.0, random.uniform(-1.0, 1.0)};
  }
  EXPECT_FALSE(find_clock_offset(relations_of(drive(), 0.0), other, {0.0}));
}

}  // namespace
}  // namespace tools
