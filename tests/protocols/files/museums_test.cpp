// The museums that come with Docent: sound, complete in both languages, and each with what it is there to try.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "protocols/files/site_file.hpp"
#include "robot/geometry/polygon.hpp"

namespace {

using files::check_site;
using files::load_site;

const std::filesystem::path sites = "static/sites";

bool has_hazard(const robot::Museum& museum, robot::HazardKind kind) {
  return std::any_of(museum.hazards.begin(), museum.hazards.end(), [&](const auto& h) { return h.kind == kind; });
}

// Share of the hazard's edge that the laser's map shows as free floor.
double free_share_of_edge(const robot::Museum& museum, const robot::Polygon& polygon) {
  int free = 0, all = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    for (double t = 0.0; t < 1.0; t += 0.01, ++all) {
      const robot::Point p{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      if (robot::is_free(museum.map[museum.map.cell(p)])) ++free;
    }
  }
  return static_cast<double>(free) / all;
}

// Whether somebody who stands at the pose and looks ahead sees the outline within 4 m, or stands below it.
bool looks_at(const robot::Pose& pose, const robot::Polygon& outline) {
  for (double s = 0.0; s < 4.0; s += 0.05) {
    if (robot::contains(outline, {pose.x + s * std::cos(pose.theta), pose.y + s * std::sin(pose.theta)})) return true;
  }
  return false;
}

class Museums : public testing::TestWithParam<const char*> {};

TEST_P(Museums, HaveNoProblem) {
  for (const auto& problem : check_site(sites / GetParam())) ADD_FAILURE() << files::to_text(problem);
}

TEST_P(Museums, SayEverythingInBothLanguages) {
  const auto museum = load_site(sites / GetParam());
  const auto both = testing::AllOf(testing::Contains(testing::Key("en")), testing::Contains(testing::Key("de")));
  for (const auto& exhibit : museum.exhibits) {
    EXPECT_THAT(exhibit.to, both) << exhibit.id;
    EXPECT_THAT(exhibit.about, both) << exhibit.id;
    EXPECT_EQ(exhibit.narrations.size(), 2u) << exhibit.id;
    for (const auto& narration : exhibit.narrations) {
      EXPECT_THAT(narration.text, both) << exhibit.id;
      EXPECT_GE(narration.duration.count(), 14.0) << exhibit.id;
      EXPECT_LE(narration.duration.count(), 26.0) << exhibit.id;
    }
  }
  EXPECT_GE(museum.tours.size(), 3u);
}

TEST_P(Museums, ShowASmallPictureOfEachExhibit) {
  for (const auto& exhibit : load_site(sites / GetParam()).exhibits) {
    ASSERT_FALSE(exhibit.picture.empty()) << exhibit.id;
    EXPECT_LE(std::filesystem::file_size(sites / GetParam() / exhibit.picture), 8192u) << exhibit.id;
  }
}

TEST_P(Museums, LookAtTheExhibitFromEachViewpoint) {
  for (const auto& exhibit : load_site(sites / GetParam()).exhibits) {
    for (std::size_t i = 0; i < exhibit.viewpoints.size(); ++i) {
      EXPECT_TRUE(looks_at(exhibit.viewpoints[i].pose, exhibit.outline)) << exhibit.id << " " << i;
    }
  }
}

TEST_P(Museums, DoNotDrawHazardsIntoTheLasersMap) {
  const auto museum = load_site(sites / GetParam());
  for (const auto& hazard : museum.hazards) EXPECT_GT(free_share_of_edge(museum, hazard.polygon), 0.25) << hazard.id;
}

INSTANTIATE_TEST_SUITE_P(All, Museums, testing::Values("rhine-hall", "material-hall"),
                         [](const auto& site) { return std::string(site.param).substr(0, 5); });

TEST(RhineHall, IsSmallWithManyViewpointsGlassAPlateAndStairs) {
  const auto museum = load_site(sites / "rhine-hall");
  EXPECT_EQ(museum.map.width(), 600);
  EXPECT_EQ(museum.map.height(), 600);
  EXPECT_EQ(museum.exhibits.size(), 13u);
  const auto popular = std::count_if(museum.exhibits.begin(), museum.exhibits.end(),
                                     [](const auto& e) { return e.viewpoints.size() >= 8; });
  EXPECT_EQ(popular, 4);
  for (const auto& exhibit : museum.exhibits) EXPECT_LE(exhibit.viewpoints.size(), 12u) << exhibit.id;
  for (auto kind : {robot::HazardKind::glass, robot::HazardKind::low_obstacle, robot::HazardKind::staircase}) {
    EXPECT_TRUE(has_hazard(museum, kind));
  }
  EXPECT_FALSE(robot::contains(museum.boundary, {12.0, 3.0})) << "the entrance lies outside";
}

TEST(MaterialHall, IsLargeWithAnEscalatorAndAnOpenCentre) {
  const auto museum = load_site(sites / "material-hall");
  EXPECT_EQ(museum.map.width(), 1340);
  EXPECT_EQ(museum.map.height(), 1060);
  EXPECT_EQ(museum.exhibits.size(), 23u);
  EXPECT_TRUE(has_hazard(museum, robot::HazardKind::escalator));
  EXPECT_TRUE(has_hazard(museum, robot::HazardKind::glass));
  for (double x = -10.0; x <= 10.0; x += 0.1) {
    for (double y = -10.0; y <= 10.0; y += 0.1) {
      if (std::hypot(x, y) > 10.0) continue;
      ASSERT_TRUE(robot::is_free(museum.map[museum.map.cell({33.5 + x, 26.5 + y})])) << x << " " << y;
    }
  }
}

}  // namespace
