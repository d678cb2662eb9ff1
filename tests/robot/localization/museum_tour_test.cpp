// The recorded museum tour (177 m, 1712 scans of 181 beams): accuracy while tracking, among people and from nothing.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "protocols/files/map_server_file.hpp"
#include "protocols/files/pose_file.hpp"
#include "protocols/files/sensor_log.hpp"
#include "robot/localization/localizer.hpp"

namespace robot {
namespace {

struct Errors {
  std::vector<double> metres, angle;
  double metres_at(double share) const { return at(metres, share); }
  double angle_at(double share) const { return at(angle, share); }
  static double at(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
  }
};

class MuseumTour : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* root = std::getenv("DOCENT_DATA");
    folder = std::filesystem::path(root ? root : "../shared/data") / "peer-workload";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recorded data in " << folder << " (set DOCENT_DATA)";
  }

  // People stand round the robot anew at each scan, over this share of its view.
  static void block(LaserScan& scan, double share, Random& random) {
    for (std::size_t i = 0; i < scan.ranges.size();) {
      const std::size_t end = std::min(scan.ranges.size(), i + 5 + random.index(25));
      const bool blocked = random.chance(share);
      const auto range = static_cast<float>(random.uniform(0.4, 2.9));
      for (; i < end; ++i) scan.ranges[i] = blocked ? std::min(scan.ranges[i], range) : scan.ranges[i];
    }
  }

  Errors run(const char* map, bool from_nothing, double blocked) const {
    const auto log = files::read_log(folder / "museum_tour181.log.gz");
    const auto truth = files::read_poses(folder / "museum_tour181.gt.txt.gz");
    Localizer localizer(files::read_pgm_map(folder / map, 0.05, {}), {}, 1);
    Random random(7);
    Errors errors;
    Pose odom;
    bool started = false;
    for (const auto& entry : log.entries) {
      if (const auto* odometry = std::get_if<Odometry>(&entry)) {
        odom = odometry->odom_from_base;
        localizer.move(odom, odometry->time);
        continue;
      }
      files::LoggedScan logged = std::get<files::LoggedScan>(entry);
      const auto pose = files::pose_at(truth, to_seconds(logged.scan.time) + log.clock_offset);
      if (!pose) continue;
      if (!started && from_nothing) localizer.start_globally();
      if (!started && !from_nothing) localizer.start_at(*pose, 0.2, 0.1);
      started = true;
      block(logged.scan, blocked, random);
      localizer.update(logged.scan, logged.base_from_laser, odom);
      localizer.work(400);
      const Estimate estimate = localizer.estimate();
      if (from_nothing && errors.metres.empty() && !estimate.localized) continue;
      errors.metres.push_back(distance(estimate.map_from_base.position(), pose->position()));
      errors.angle.push_back(std::abs(wrap_angle(estimate.map_from_base.theta - pose->theta)));
    }
    return errors;
  }

  std::filesystem::path folder;
};

TEST_F(MuseumTour, IsTrackedToACentimetre) {
  for (const char* map : {"museum_hollow.pgm.gz", "museum.pgm.gz"}) {
    const Errors errors = run(map, false, 0.0);
    ASSERT_GT(errors.metres.size(), 1700u);
    EXPECT_LT(errors.metres_at(0.5), 0.010) << map;
    EXPECT_LT(errors.metres_at(0.99), 0.03) << map;
    EXPECT_LT(errors.angle_at(0.99), radians(0.3)) << map;
  }
}

TEST_F(MuseumTour, IsTrackedAmongPeople) {
  const Errors errors = run("museum_hollow.pgm.gz", false, 0.5);
  EXPECT_LT(errors.metres_at(0.5), 0.02);
  EXPECT_LT(errors.metres_at(0.99), 0.10);
  EXPECT_LT(errors.metres_at(1.0), 0.5);
}

TEST_F(MuseumTour, IsFoundFromNothing) {
  const Errors errors = run("museum_hollow.pgm.gz", true, 0.0);
  ASSERT_GT(errors.metres.size(), 1650u);  // within ten seconds
  EXPECT_LT(errors.metres_at(1.0), 0.1);
}

}  // namespace
}  // namespace robot
