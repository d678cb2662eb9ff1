#include "robot/localization/scan_match.hpp"

#include <gmock/gmock.h>

#include "robot/geometry/ray_cast.hpp"
#include "tests/support/ascii_world.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/simulated_scan.hpp"

namespace robot {
namespace {

using testing::ascii_world;
using testing::PoseNear;
using testing::ScanSetup;
using testing::take_scan;

constexpr double cell = 0.1;

OccupancyGrid room() {
  std::vector<std::string> rows{std::string(60, '#')};
  for (int i = 0; i < 38; ++i) rows.push_back("#" + std::string(58, '.') + "#");
  for (int i = 10; i < 20; ++i) rows[static_cast<std::size_t>(i)].replace(12, 5, "#####");
  rows.push_back(std::string(60, '#'));
  return ascii_world(cell, rows);
}

OccupancyGrid corridor() {
  std::vector<std::string> rows{std::string(400, '#')};
  for (int i = 0; i < 20; ++i) rows.push_back(std::string(400, '.'));
  rows.push_back(std::string(400, '#'));
  return ascii_world(cell, rows);
}

Eigen::Matrix3d spread(double metres, double angle) {
  return Eigen::Vector3d(metres * metres, metres * metres, angle * angle).asDiagonal();
}

struct Fixture {
  explicit Fixture(const OccupancyGrid& grid) : map(grid), caster(map), field(map, {}) {}
  Beams scan(const Pose& truth, double sigma = 0.0) {
    return beams_of(take_scan(caster, truth, ScanSetup{.sigma = sigma}, random), {});
  }
  ScanMatch match(const Beams& beams, const Pose& start, const Eigen::Matrix3d& prior) const {
    return match_scan(field.distances(), cell / 2, beams.beams, start, prior, {});
  }
  OccupancyGrid map;
  RayCaster caster;
  LikelihoodField field;
  Random random{3};
};

TEST(ScanMatch, FindsThePoseToAFewMillimetres) {
  Fixture f(room());
  const Pose truth{3.1, 1.6, 0.4};
  const auto match = f.match(f.scan(truth), {3.2, 1.5, 0.45}, spread(0.2, 0.1));
  EXPECT_THAT(match.pose, PoseNear(truth, 0.008, 0.004));
  EXPECT_GT(match.fit, 0.9);
  EXPECT_NEAR(match.residual, 0.0, 0.01);
}

TEST(ScanMatch, TellsWhereTheSurfacesLie) {
  Fixture f(room());
  const Pose truth{3.1, 1.6, 0.4};
  const auto beams = f.scan(truth);
  const auto match = match_scan(f.field.distances(), 0.0, beams.beams, truth, spread(0.001, 0.001), {});
  EXPECT_NEAR(match.residual, cell / 2, 0.02);  // before the cells' centres by half a cell
}

TEST(ScanMatch, AlongACorridorTheBeliefDecides) {
  Fixture f(corridor());
  const Pose truth{20.0, 1.1, 0.0}, start{19.0, 1.2, 0.03};
  LaserScan scan = take_scan(f.caster, truth, {}, f.random);
  for (auto& range : scan.ranges) range = range > 8.0f ? scan.max_range : range;
  const auto match = f.match(beams_of(scan, {}), start, spread(0.3, 0.1));
  EXPECT_NEAR(match.pose.y, truth.y, 0.01);
  EXPECT_NEAR(match.pose.theta, truth.theta, 0.005);
  EXPECT_NEAR(match.pose.x, start.x, 0.1);
  EXPECT_GT(std::sqrt(match.covariance(0, 0)), 0.2);
  EXPECT_LT(std::sqrt(match.covariance(1, 1)), 0.03);
}

TEST(ScanMatch, PeopleHaveNoSay) {
  Fixture f(room());
  const Pose truth{3.1, 1.6, 0.4};
  const std::vector<testing::Somebody> crowd{{{4.0, 2.0}}, {{3.9, 1.6}}, {{3.6, 2.6}}};
  const LaserScan scan = take_scan(f.caster, truth, ScanSetup{.sigma = 0.01}, f.random, {}, crowd);
  const auto match = f.match(beams_of(scan, {}), {3.15, 1.55, 0.42}, spread(0.2, 0.1));
  EXPECT_THAT(match.pose, PoseNear(truth, 0.02, 0.01));
}

TEST(ScanMatch, WithoutBeamsOrSurfacesTheBeliefStays) {
  Fixture f(room());
  const Pose start{3.0, 1.5, 0.1};
  EXPECT_THAT(f.match(Beams{}, start, spread(0.1, 0.1)).pose, PoseNear(start, 1e-12));
  Fixture open(ascii_world(cell, {"....", "...."}));
  const auto match = open.match(f.scan({3.1, 1.6, 0.4}), start, spread(0.1, 0.1));
  EXPECT_THAT(match.pose, PoseNear(start, 1e-9));
  EXPECT_EQ(match.fit, 0.0);
}

TEST(SearchNearby, FindsBackAfterALongSlip) {
  Fixture f(room());
  const Pose truth{3.1, 1.6, 0.4};
  const auto match = search_nearby(f.field, f.scan(truth, 0.01).beams, {2.4, 2.2, -0.1}, {});
  EXPECT_THAT(match.pose, PoseNear(truth, 0.06, 0.02));
}

}  // namespace
}  // namespace robot
