#include "protocols/files/site_file.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "protocols/files/map_server_file.hpp"
#include "tests/support/hostile_bytes.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace files {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string sound_site = R"(id = "small-hall"
languages = ["en", "de"]
map = "map.yaml"
home = { x = 2.0, y = 2.0, theta_deg = 90 }
boundary = [[0.5, 0.5], [11.5, 0.5], [11.5, 7.5], [0.5, 7.5]]
[title]
en = "Small hall"
de = "Kleine Halle"
[speed]
open_mps = 0.6
[[hazard]]
id = "plate"
kind = "low_obstacle"
polygon = [[5.0, 2.0], [6.0, 2.0], [6.0, 3.0], [5.0, 3.0]]
title = { en = "Plate", de = "Platte" }
[[area]]
title = { en = "Hall", de = "Halle" }
label = [6.0, 4.0]
[[camera]]
id = "door"
title = { en = "Door", de = "Tür" }
x = 1.0
y = 1.0
theta_deg = 45
height = 3.0
tilt_deg = -30
field_of_view_deg = 80
[[exhibit]]
id = "engine"
number = 1
title = { en = "Engine", de = "Maschine" }
summary = { en = "It turned.", de = "Sie drehte." }
outline = [[9.0, 6.0], [10.0, 6.0], [10.0, 7.0], [9.0, 7.0]]
icon = "wheel"
picture = "engine.jpg"
[[exhibit.viewpoint]]
x = 9.0
y = 5.0
theta_deg = 90
[[exhibit.narration]]
text = { en = "Look.", de = "Schau." }
seconds = 12
[[tour]]
id = "short"
title = { en = "Short", de = "Kurz" }
summary = { en = "One thing.", de = "Ein Ding." }
exhibits = ["engine"]
)";

// A free hall of 12 x 8 m with walls round it and a closet at the right that is closed.
robot::OccupancyGrid hall() {
  robot::OccupancyGrid map(240, 160, 0.05, {0.0, 0.0}, robot::free_cell);
  for (int x = 0; x < 240; ++x) {
    for (int y = 0; y < 160; ++y) {
      const bool wall = x == 0 || y == 0 || x == 239 || y == 159;
      const bool closet = (x == 200 && y < 60) || (y == 60 && x >= 200);
      if (wall || closet) map[{x, y}] = robot::occupied_cell;
    }
  }
  return map;
}

class SiteFile : public ::testing::Test {
 protected:
  SiteFile() {
    write_map_server(folder_.path() / "map.yaml", hall());
    folder_.write("engine.jpg", "picture");
  }

  // The sound museum with one text replaced by another, as lines of complaints.
  std::vector<std::string> complaints(const std::string& from, const std::string& to) {
    std::string text = sound_site;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    folder_.write("site.toml", text);
    std::vector<std::string> lines;
    for (const auto& problem : check_site(folder_.path())) lines.push_back(to_text(problem));
    return lines;
  }

  testing_support::TemporaryFolder folder_;
};

TEST_F(SiteFile, ReadsEverything) {
  folder_.write("site.toml", sound_site);
  const auto museum = load_site(folder_.path());
  EXPECT_EQ(museum.id, "small-hall");
  EXPECT_EQ(museum.title.at("de"), "Kleine Halle");
  EXPECT_EQ(museum.map, hall());
  EXPECT_THAT(museum.home, robot::testing::PoseNear(robot::Pose{2.0, 2.0, robot::pi / 2}, 1e-9));
  EXPECT_THAT(museum.boundary, SizeIs(4));
  EXPECT_DOUBLE_EQ(museum.speed.open_mps, 0.6);
  EXPECT_DOUBLE_EQ(museum.speed.web_only_mps, robot::SpeedLimits{}.web_only_mps);
  ASSERT_THAT(museum.hazards, SizeIs(1));
  EXPECT_EQ(museum.hazards[0].kind, robot::HazardKind::low_obstacle);
  ASSERT_THAT(museum.cameras, SizeIs(1));
  EXPECT_NEAR(museum.cameras[0].tilt, robot::radians(-30), 1e-12);
  ASSERT_THAT(museum.exhibits, SizeIs(1));
  const auto& engine = museum.exhibits[0];
  EXPECT_EQ(engine.number, 1);
  EXPECT_EQ(engine.picture, "engine.jpg");
  ASSERT_THAT(engine.viewpoints, SizeIs(1));
  EXPECT_NEAR(engine.viewpoints[0].pose.theta, robot::pi / 2, 1e-12);
  ASSERT_THAT(engine.narrations, SizeIs(1));
  EXPECT_EQ(engine.narrations[0].text.at("de"), "Schau.");
  EXPECT_DOUBLE_EQ(engine.narrations[0].duration.count(), 12.0);
  ASSERT_THAT(museum.tours, SizeIs(1));
  EXPECT_EQ(museum.tours[0].exhibits[0], "engine");
  EXPECT_THAT(museum.areas, SizeIs(1));
}

TEST_F(SiteFile, FindsEachMistakeOnItsLine) {
  const std::pair<std::pair<const char*, const char*>, const char*> mistakes[] = {
      {{"id = \"small-hall\"", "id = \"Small Hall\""}, "site.toml:1: id is not usable"},
      {{"\"Kleine Halle\"", "\"\""}, "site.toml:8: title has no usable text in language \"de\""},
      {{"languages = [\"en\", \"de\"]", "languages = [\"de\"]"}, "site.toml:2: languages leaves out \"en\""},
      {{"languages = [\"en\", \"de\"]", "languages = [\"en\"]"}, "\"de\", which is not a language here"},
      {{"map = \"map.yaml\"", "map = \"plan.yaml\""}, "plan.yaml: no such file"},
      {{"theta_deg = 90 }", "theta_deg = nan }"}, "site.toml:4: theta_deg is not a number"},
      {{"[11.5, 7.5]", "[inf, 7.5]"}, "site.toml:5: boundary has a corner"},
      {{"open_mps = 0.6", "open_mps = 60"}, "site.toml:10: open_mps is not a number from 0.05 to 2"},
      {{"open_mps", "open_msp"}, "site.toml:10: unknown key \"open_msp\""},
      {{"low_obstacle", "banana"}, "unknown kind of hazard \"banana\""},
      {{"[6.0, 2.0], [6.0, 3.0]", "[6.0, 3.0], [6.0, 2.0]"}, "site.toml:14: polygon crosses itself"},
      {{", [6.0, 3.0], [5.0, 3.0]]", "]"}, "site.toml:14: polygon is not a polygon"},
      {{"[6.0, 3.0], [5.0, 3.0]]", "[7.0, 2.0]]"}, "site.toml:14: polygon has no area"},
      {{"number = 1", ""}, "number is missing"},
      {{"number = 1", "number = \"one\""}, "number is not a number from 1 to 9999"},
      {{"engine.jpg", "motor.jpg"}, "there is no picture motor.jpg"},
      {{"engine.jpg", "../engine.jpg"}, "outside of the site's folder"},
      {{"[\"engine\"]", "[\"engine\", \"rocket\"]"}, "the tour visits \"rocket\", which is no exhibit"},
      {{"seconds = 12", "seconds = 0"}, "seconds is not a number from 1 to 600"},
      {{"label = [6.0, 4.0]", "label = [60.0, 4.0]"}, "label of an area at (60.00, 4.00) is off the map"},
      {{"[[exhibit.viewpoint]]\nx = 9.0\ny = 5.0\ntheta_deg = 90\n", ""}, "the exhibit has no viewpoint"},
      {{"id = \"plate\"", "id = plate"}, "site.toml:12:"},
  };
  for (const auto& [change, expected] : mistakes) {
    EXPECT_THAT(complaints(change.first, change.second), Contains(HasSubstr(expected))) << change.second;
  }
}

TEST_F(SiteFile, FindsPlacesWhereTheRobotCannotBe) {
  const auto moved = [&](const char* x, const char* y) {
    return complaints("x = 9.0\ny = 5.0", std::string("x = ") + x + "\ny = " + y);
  };
  EXPECT_THAT(moved("9.0", "5.0"), IsEmpty());
  EXPECT_THAT(moved("50.0", "5.0"), Contains(HasSubstr("is off the map")));
  EXPECT_THAT(moved("0.2", "5.0"), Contains(HasSubstr("is outside of the boundary")));
  EXPECT_THAT(moved("10.02", "1.0"), Contains(HasSubstr("is inside of an obstacle")));
  EXPECT_THAT(moved("5.5", "2.5"), Contains(HasSubstr("touches hazard \"plate\"")));
  EXPECT_THAT(moved("5.5", "3.2"), Contains(HasSubstr("touches hazard \"plate\"")));
  EXPECT_THAT(moved("9.75", "1.5"), Contains(HasSubstr("no room to turn")));
  EXPECT_THAT(moved("11.0", "1.5"), Contains(HasSubstr("cannot be reached from home")));
}

TEST_F(SiteFile, FindsIdsUsedTwice) {
  const auto again =
      complaints("[[tour]]", "[[hazard]]\nid = \"plate\"\nkind = \"glass\"\npolygon = [[1,1],[2,1],[2,2]]\n[[tour]]");
  EXPECT_THAT(again, Contains(HasSubstr("hazard \"plate\" is there twice")));
}

TEST_F(SiteFile, LoadThrowsAllProblemsAtOnce) {
  complaints("number = 1", "number = 0");
  try {
    load_site(folder_.path());
    FAIL() << "was loaded";
  } catch (const SiteError& error) {
    EXPECT_THAT(error.problems(), SizeIs(1));
    EXPECT_THAT(error.what(), HasSubstr("site.toml:30: number"));
  }
}

TEST_F(SiteFile, MissingFolderIsOneClearProblem) {
  const auto problems = check_site(folder_.path() / "nowhere");
  ASSERT_THAT(problems, SizeIs(1));
  EXPECT_THAT(to_text(problems[0]), HasSubstr("site.toml: no such file"));
}

RC_GTEST_FIXTURE_PROP(SiteFile, DamagedFilesAreReadOrRefused, ()) {
  folder_.write("site.toml", *testing_support::damaged(sound_site));
  try {
    const auto museum = load_site(folder_.path());
    RC_ASSERT(!museum.exhibits.empty());
    RC_ASSERT(robot::is_finite(museum.home));
  } catch (const SiteError& error) {
    RC_ASSERT(!error.problems().empty());
  }
}

}  // namespace
}  // namespace files
