#include "robot/localization/global_search.hpp"

#include <gmock/gmock.h>

#include "tests/support/ascii_world.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/simulated_scan.hpp"

namespace robot {
namespace {

using testing::ascii_world;
using testing::PoseNear;
using testing::ScanSetup;
using testing::take_scan;

// A hall with pillars that are nowhere arranged alike.
OccupancyGrid hall() {
  std::vector<std::string> rows{std::string(200, '#')};
  for (int i = 0; i < 138; ++i) rows.push_back("#" + std::string(198, '.') + "#");
  rows.push_back(std::string(200, '#'));
  Random random(11);
  for (int k = 0; k < 25; ++k) {
    const auto x = 5 + random.index(180), y = 5 + random.index(125), w = 3 + random.index(9), h = 3 + random.index(9);
    for (auto r = y; r < std::min<std::size_t>(y + h, 139); ++r) rows[r].replace(x, w, std::string(w, '#'));
  }
  return ascii_world(0.1, rows);
}

// A room that looks the same from either end.
OccupancyGrid turned_alike() {
  std::vector<std::string> rows{std::string(80, '#')};
  for (int i = 0; i < 40; ++i) rows.push_back("#" + std::string(78, '.') + "#");
  for (std::size_t i = 5; i < 10; ++i) rows[i].replace(10, 6, "######");
  for (std::size_t i = 32; i < 37; ++i) rows[i].replace(64, 6, "######");
  rows.push_back(std::string(80, '#'));
  return ascii_world(0.1, rows);
}

struct Fixture {
  explicit Fixture(const OccupancyGrid& grid)
      : map(grid), caster(map), field(map, {}, 0.05), search(map, caster, field) {}
  Look look(const Pose& truth, const std::vector<testing::Somebody>& people = {}, bool both = true) {
    const ScanSetup setup{.sigma = 0.02};
    Look result{{beams_of(take_scan(caster, truth, setup, random, {}, people), {})}};
    const Pose rear{0.0, 0.0, pi};
    if (both) result.lasers.push_back(beams_of(take_scan(caster, truth * rear, setup, random, {}, people), rear));
    return result;
  }
  std::vector<Peak> run(const Look& where, int units = 1000000) {
    search.start(where);
    while (search.step(units)) {
    }
    return search.peaks();
  }
  Pose random_free_pose() {
    for (;;) {
      const Point p{random.uniform(0.0, map.width() * 0.1), random.uniform(0.0, map.height() * 0.1)};
      if (map.contains(p) && field.distances()[map.cell(p)] > 0.4) return {p.x, p.y, random.uniform(-pi, pi)};
    }
  }
  OccupancyGrid map;
  RayCaster caster;
  LikelihoodField field;
  GlobalSearch search;
  Random random{5};
};

TEST(GlobalSearch, FindsThePlaceFromOneLook) {
  Fixture f(hall());
  int found = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose truth = f.random_free_pose();
    const auto peaks = f.run(f.look(truth));
    ASSERT_FALSE(peaks.empty());
    found += distance(peaks[0].pose.position(), truth.position()) < 0.1 &&
                     std::abs(wrap_angle(peaks[0].pose.theta - truth.theta)) < 0.05
                 ? 1
                 : 0;
  }
  EXPECT_GE(found, 19);
}

TEST(GlobalSearch, FindsItAmongPeopleToo) {
  Fixture f(hall());
  int found = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose truth = f.random_free_pose();
    std::vector<testing::Somebody> ring;
    for (int k = 0; k < 8; ++k) {
      const double angle = f.random.uniform(-pi, pi), way = f.random.uniform(0.6, 2.0);
      ring.push_back({{truth.x + way * std::cos(angle), truth.y + way * std::sin(angle)}, 0.25});
    }
    const auto peaks = f.run(f.look(truth, ring));
    found += !peaks.empty() && distance(peaks[0].pose.position(), truth.position()) < 0.2 ? 1 : 0;
  }
  EXPECT_GE(found, 18);
}

TEST(GlobalSearch, ReturnsBothPlacesThatLookAlike) {
  Fixture f(turned_alike());
  const Pose truth{2.5, 1.5, 0.3};
  const Pose twin{8.0 - truth.x, 4.2 - truth.y, wrap_angle(truth.theta + pi)};
  const auto peaks = f.run(f.look(truth));
  ASSERT_GE(peaks.size(), 2u);
  std::vector<Pose> best{peaks[0].pose, peaks[1].pose};
  EXPECT_THAT(best, ::testing::UnorderedElementsAre(PoseNear(truth, 0.1, 0.05), PoseNear(twin, 0.1, 0.05)));
  EXPECT_NEAR(peaks[0].score, peaks[1].score, 3.0);
}

TEST(GlobalSearch, SlicesGiveWhatOneCallGives) {
  Fixture f(hall());
  const Look look = f.look({7.3, 3.1, 1.0});
  const auto at_once = f.run(look), sliced = f.run(look, 1);
  ASSERT_EQ(at_once.size(), sliced.size());
  for (std::size_t i = 0; i < sliced.size(); ++i) {
    EXPECT_EQ(at_once[i].pose, sliced[i].pose);
    EXPECT_EQ(at_once[i].score, sliced[i].score);
  }
}

TEST(GlobalSearch, NothingSeenIsNothingFound) {
  Fixture f(hall());
  EXPECT_TRUE(f.run(Look{}).empty());
  EXPECT_TRUE(f.run(Look{{Beams{}}}).empty());
  Fixture none(OccupancyGrid{});
  EXPECT_TRUE(none.run(f.look({7.3, 3.1, 1.0})).empty());
}

TEST(JudgePlace, NobodyLooksThroughWalls) {
  Fixture f(hall());
  const Pose truth{7.3, 3.1, 1.0};
  const Look look = f.look(truth);
  const double right = judge_place(f.caster, f.field, look, truth).score;
  EXPECT_GT(right, judge_place(f.caster, f.field, look, truth * Pose{0.5, 0.0, 0.0}).score + 10.0);
  EXPECT_GT(judge_place(f.caster, f.field, look, truth).share, 0.9);
}

}  // namespace
}  // namespace robot
