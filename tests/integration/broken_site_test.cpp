// A broken museum given to the real program: it does not begin, and says in one line a mistake which file, which line
// and what to mend.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

using testing::HasSubstr;
using testing::Not;
using testing_support::TemporaryFolder;

namespace {

struct Outcome {
  int code = 0;
  std::string words;
};

Outcome run(const std::string& arguments) {
  Outcome outcome;
  // Ends by itself even if it should take the museum for sound.
  FILE* pipe = popen(("timeout 20 " + std::string(std::getenv("DOCENT")) + " " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (pipe && fgets(buffer.data(), buffer.size(), pipe)) outcome.words += buffer.data();
  const int status = pipe ? pclose(pipe) : 0;
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

class BrokenSite : public ::testing::Test {
 protected:
  BrokenSite() {
    std::filesystem::copy("static/sites/rhine-hall", site(), std::filesystem::copy_options::recursive);
    std::ifstream file(site() / "site.toml");
    text_.assign(std::istreambuf_iterator<char>(file), {});
  }
  std::filesystem::path site() const { return folder_.path() / "museum"; }

  // Both commands refuse it, with these words.
  void expect_refused(const std::string& where, const std::string& what) {
    const Outcome check = run("check " + site().string());
    EXPECT_EQ(check.code, 1) << check.words;
    EXPECT_THAT(check.words, HasSubstr(where));
    EXPECT_THAT(check.words, HasSubstr(what));
    const Outcome serve =
        run("serve --port=0 --site=" + site().string() + " --database=" + (folder_.path() / "db").string());
    EXPECT_EQ(serve.code, 1) << serve.words;
    EXPECT_THAT(serve.words, HasSubstr(where));
    EXPECT_THAT(serve.words, HasSubstr(what));
    EXPECT_THAT(serve.words, Not(HasSubstr("http://")));
  }
  void replace(const std::string& from, const std::string& to) {
    std::string text = text_;
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(site() / "site.toml") << text.replace(at, from.size(), to);
  }

  TemporaryFolder folder_;
  std::string text_;
};

TEST_F(BrokenSite, WithoutItsFilesIsRefused) {
  std::filesystem::remove(site() / "map.pgm");
  expect_refused("map.pgm", "no such file");
  std::filesystem::remove(site() / "site.toml");
  expect_refused("site.toml", "no such file");
}

TEST_F(BrokenSite, ThatIsNoTomlIsRefusedOnItsLine) {
  replace("home = {", "home = [");
  expect_refused("site.toml:8", "");
}

TEST_F(BrokenSite, WithAValueThatCannotBeIsRefusedOnItsLine) {
  replace("theta_deg = -90", "theta_deg = nan");
  expect_refused("site.toml:8", "theta_deg is not a number");
  replace("open_mps = 0.7", "open_mps = 70");
  expect_refused("site.toml:18", "open_mps is not a number from 0.05 to 2");
}

TEST_F(BrokenSite, WhereTheRobotCannotStandIsRefused) {
  replace("home = { x = 13.6, y = 6.9", "home = { x = 0.0, y = 0.0");
  expect_refused("site.toml:8", "home");
}

TEST_F(BrokenSite, WithAMapThatIsNoPictureIsRefused) {
  std::ofstream(site() / "map.pgm") << "P5 1000000 1000000 255\nnot that many";
  expect_refused("map.pgm", "");
}

}  // namespace
