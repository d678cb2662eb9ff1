#include "protocols/files/pose_file.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "protocols/files/problem.hpp"
#include "tests/support/hostile_bytes.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace files {
namespace {

using robot::testing::PoseNear;
using ::testing::HasSubstr;
using ::testing::Optional;
using ::testing::SizeIs;

TEST(PoseFile, ReadsAllItsShapes) {
  const auto reference = parse_poses("# head\n0 1.5 1 2 0.5 0\n1 2.5 2 2 0.5 1\n", "a");
  const auto truth = parse_poses("1.5 1 2 0.5\n2.5 2 2 0.5\n", "a");
  const auto csv = parse_poses("time,x,y,theta\n1.5,1,2,0.5\n2.5,2,2,0.5\n", "a");
  for (const auto& track : {reference, truth, csv}) {
    ASSERT_THAT(track, SizeIs(2));
    EXPECT_DOUBLE_EQ(track[1].time, 2.5);
    EXPECT_THAT(track[1].pose, PoseNear(robot::Pose{2, 2, 0.5}, 1e-9));
  }
  const auto log = parse_poses("FLASER 2 1 2 5 6 0.1 5 6 0.1 9 h 3\n", "a");
  ASSERT_THAT(log, SizeIs(1));
  EXPECT_DOUBLE_EQ(log[0].time, 3.0);
  EXPECT_THAT(log[0].pose, PoseNear(robot::Pose{5, 6, 0.1}, 1e-9));
}

TEST(PoseFile, StampsThatRanBackwardsAreSorted) {
  const auto track = parse_poses("2 0 0 0\n1 5 0 0\n", "a");
  EXPECT_DOUBLE_EQ(track[0].time, 1.0);
  EXPECT_DOUBLE_EQ(track[0].pose.x, 5.0);
}

TEST(PoseFile, InterpolatesTheShortWayRound) {
  const PoseTrack track = {{0.0, {0, 0, 3.1}}, {1.0, {2, 0, -3.1}}};
  const auto halfway = pose_at(track, 0.5);
  ASSERT_TRUE(halfway);
  EXPECT_DOUBLE_EQ(halfway->x, 1.0);
  EXPECT_NEAR(std::abs(halfway->theta), robot::pi, 1e-9);
}

TEST(PoseFile, SaysNothingAboutTimesThatItDoesNotKnow) {
  const PoseTrack track = {{0.0, {0, 0, 0}}, {1.0, {1, 0, 0}}, {9.0, {9, 0, 0}}};
  EXPECT_FALSE(pose_at(track, -1.0));
  EXPECT_FALSE(pose_at(track, 10.0));
  EXPECT_FALSE(pose_at(track, 5.0)) << "eight seconds without a pose";
  EXPECT_THAT(pose_at(track, 1.02), Optional(PoseNear(robot::Pose{1, 0, 0}, 1e-9)));
  EXPECT_THAT(pose_at(track, 9.0), Optional(PoseNear(robot::Pose{9, 0, 0}, 1e-9)));
  EXPECT_FALSE(pose_at({}, 0.0));
}

RC_GTEST_PROP(PoseFile, WrittenTracksComeBack, ()) {
  PoseTrack track;
  const int count = *rc::gen::inRange(1, 30);
  for (int i = 0; i < count; ++i) {
    track.push_back({i * 0.125, {*rc::gen::inRange(-9999, 9999) / 64.0, -1.5, *rc::gen::inRange(-3, 3) * 1.0}});
  }
  const testing_support::TemporaryFolder folder;
  write_poses(folder.path() / "poses.csv", track);
  const auto back = read_poses(folder.path() / "poses.csv");
  RC_ASSERT(back.size() == track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    RC_ASSERT(std::abs(back[i].time - track[i].time) < 1e-6);
    RC_ASSERT(robot::distance(back[i].pose.position(), track[i].pose.position()) < 2e-6);
  }
}

TEST(PoseFile, ReadsRelations) {
  const auto relations = parse_relations("10.5 11.5 0.4 -0.01 0 0 0 -0.07\n", "a");
  ASSERT_THAT(relations, SizeIs(1));
  EXPECT_DOUBLE_EQ(relations[0].to_time, 11.5);
  EXPECT_THAT(relations[0].relative, PoseNear(robot::Pose{0.4, -0.01, -0.07}, 1e-9));
}

TEST(PoseFile, NamesTheLineThatIsWrong) {
  const auto complaint = [](auto read) -> std::string {
    try {
      read();
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint([] { parse_poses("1 2 3 4\n1 2 x 4\n", "p.txt"); }), HasSubstr("p.txt:2: is not a pose"));
  EXPECT_THAT(complaint([] { parse_poses("# nothing\n", "p.txt"); }), HasSubstr("holds no poses"));
  EXPECT_THAT(complaint([] { parse_relations("1 2 3\n", "r.txt"); }), HasSubstr("r.txt:1: is not a relation"));
}

RC_GTEST_PROP(PoseFile, DamagedTablesAreReadOrRefused, ()) {
  const auto bytes = *testing_support::damaged(
      *rc::gen::element<std::string>("0 1.5 1 2 0.5 0\n1 2.5 2 2 0.5 1\n", "time,x,y,theta\n1.5,1,2,0.5\n"));
  try {
    for (const auto& timed : parse_poses(bytes, "a")) RC_ASSERT(robot::is_finite(timed.pose));
  } catch (const FileError& error) {
    RC_ASSERT(!error.problem().text.empty());
  }
}

TEST(PoseFile, ReadsTheRecordedReferencesAndRelations) {
  const auto poses = testing_support::recorded_data("intel/intel-refposes.txt.gz");
  const auto relations = testing_support::recorded_data("intel/intel.relations.gz");
  NEED_RECORDING(poses);
  EXPECT_THAT(read_poses(poses), SizeIs(13631));
  EXPECT_THAT(read_relations(relations), SizeIs(2984));
}

}  // namespace
}  // namespace files
