#include "robot/localization/likelihood_field.hpp"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include "robot/geometry/random.hpp"
#include "tests/support/ascii_world.hpp"

namespace robot {
namespace {

using testing::ascii_world;

OccupancyGrid room() {
  return ascii_world(0.5, {"????????????",  //
                           "?##########?",  //
                           "?#........#?",  //
                           "?#...##...#?",  //
                           "?#........#?",  //
                           "?##########?"});
}

TEST(LikelihoodField, APerfectFitCostsNothing) {
  const LikelihoodField field(room(), {});
  const std::vector<Point> ends{{0.75, 1.25}, {0.75, 1.75}};  // centres of the left wall's cells
  EXPECT_NEAR(field.log_likelihood({}, ends), 0.0, 1e-6);
}

TEST(LikelihoodField, FallsWithTheDistanceAsAGaussianOverAFloor) {
  const LikelihoodConfig config{.hit_sigma = 0.2, .random = 0.1};
  const LikelihoodField field(room(), config);
  const auto at = [&](double x) { return field.log_likelihood({}, std::vector<Point>{{x, 1.25}}); };
  const double expected = std::log((std::exp(-0.5 * 0.5 / (2 * 0.04)) + 0.1) / 1.1);
  EXPECT_NEAR(at(1.25), expected, 0.03);  // one cell away; distances are kept in steps of 8 mm
  EXPECT_NEAR(at(1.75), std::log(0.1 / 1.1), 0.01);
}

TEST(LikelihoodField, TheSurfaceMayLieBeforeTheCellsCentres) {
  LikelihoodField field(room(), {.hit_sigma = 0.2});
  const std::vector<Point> next_cell{{1.25, 1.25}};
  const double before = field.log_likelihood({}, next_cell);
  field.set_surface_offset(0.5);
  EXPECT_NEAR(field.log_likelihood({}, next_cell), 0.0, 1e-3);
  EXPECT_LT(before, -1.0);
}

TEST(LikelihoodField, UnknownAndOutsideSayLittle) {
  const LikelihoodConfig config{.random = 0.1, .unknown_share = 0.5};
  const auto map = ascii_world(0.5, {"??????????", "??????????", "??????????", "??????????", "##.???????"});
  const LikelihoodField field(map, config);
  const double half = 0.5 * std::log(0.1 / 1.1);
  EXPECT_NEAR(field.log_likelihood({}, std::vector<Point>{{4.2, 2.2}}), half, 1e-3);
  EXPECT_NEAR(field.log_likelihood({}, std::vector<Point>{{-40.0, 2.2}}), half, 1e-3);
  EXPECT_FALSE(field.tells({4.2, 2.2}));
  EXPECT_FALSE(field.tells({-40.0, 2.2}));
  EXPECT_TRUE(field.tells({0.25, 0.25}));
}

TEST(LikelihoodField, SurvivesAMapWithoutSurfaces) {
  const LikelihoodField field(ascii_world(0.5, {"....", "...."}), {});
  EXPECT_TRUE(std::isfinite(field.log_likelihood({}, std::vector<Point>{{1.0, 0.5}})));
  const LikelihoodField nothing(OccupancyGrid{}, {});
  EXPECT_TRUE(std::isfinite(nothing.log_likelihood({}, std::vector<Point>{{1.0, 0.5}})));
}

// The fast way over many poses says what the textbook says, tempered.
TEST(LikelihoodField, WeighingEqualsTheTextbook) {
  const LikelihoodField field(room(), {.effective_beams = 10});
  EXPECT_TRUE(rc::check([&] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const int beams = *rc::gen::inRange(0, 70);
    std::vector<Point> ends;
    for (int i = 0; i < beams; ++i) ends.push_back({random.uniform(-6, 6), random.uniform(-6, 6)});
    std::vector<double> x, y, theta;
    for (int i = 0; i < 20; ++i) {
      x.push_back(random.uniform(-20, 20));
      y.push_back(random.uniform(-20, 20));
      theta.push_back(random.uniform(-pi, pi));
    }
    std::vector<float> fit(x.size());
    field.weigh(x, y, theta, ends, fit);
    const double temper = beams > 10 ? 10.0 / beams : 1.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      // An end on a cell's border may fall to either side in single precision.
      RC_ASSERT(std::abs(fit[i] - temper * field.log_likelihood({x[i], y[i], theta[i]}, ends)) < 0.01 + 0.2 * temper);
    }
  }));
}

}  // namespace
}  // namespace robot
