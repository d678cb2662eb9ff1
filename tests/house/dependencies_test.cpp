// The house's rules, checked on every build: who may include whom, and that the core stays pure.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;
  int line;
  std::string target;
};

std::vector<Include> includes_below(const fs::path& folder) {
  static const std::regex pattern(R"rx(^\s*#\s*include\s*[<"]([^>"]+)[>"])rx");
  std::vector<Include> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    std::string text;
    for (int line = 1; std::getline(in, text); ++line) {
      std::smatch match;
      if (std::regex_search(text, match, pattern)) found.push_back({entry.path(), line, match[1]});
    }
  }
  return found;
}

bool begins_with_any(const std::string& text, const std::vector<std::string>& heads) {
  for (const auto& head : heads) {
    if (text.rfind(head, 0) == 0) return true;
  }
  return false;
}

std::string where(const Include& include) {
  return include.file.string() + ":" + std::to_string(include.line) + " includes " + include.target;
}

TEST(House, TheCoreIncludesOnlyItselfEigenOpenCvAndCeres) {
  const std::set<std::string> impure = {"thread",     "mutex",        "condition_variable",
                                        "atomic",     "future",       "fstream",
                                        "iostream",   "ctime",        "time.h",
                                        "filesystem", "cstdio",       "stdio.h",
                                        "semaphore",  "shared_mutex", "stop_token",
                                        "random",     "locale"};
  const auto includes = includes_below("robot");
  ASSERT_GT(includes.size(), 20u) << "run from the top of the checkout";
  for (const auto& include : includes) {
    const bool standard =
        include.target.find('/') == std::string::npos && include.target.find('.') == std::string::npos;
    const bool allowed =
        standard || begins_with_any(include.target, {"robot/", "Eigen/", "opencv2/core", "opencv2/imgproc", "ceres/"});
    EXPECT_TRUE(allowed) << where(include);
    EXPECT_FALSE(impure.contains(include.target)) << where(include) << ": the core has no clock, thread, file or log";
  }
}

TEST(House, TheCoreReadsNoClockAndThrowsNoDiceOfItsOwn) {
  const std::regex forbidden(R"(::now\(\)|random_device|\brand\(\)|\bsrand\(|getenv|steady_clock|system_clock)");
  for (const auto& entry : fs::recursive_directory_iterator("robot")) {
    if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
    std::ifstream in(entry.path());
    std::string text;
    for (int line = 1; std::getline(in, text); ++line) {
      const std::string code = text.substr(0, text.find("//"));
      EXPECT_FALSE(std::regex_search(code, forbidden)) << entry.path().string() << ":" << line << ": " << text;
    }
  }
}

TEST(House, DependenciesPointFromServerToProtocolsToRobot) {
  for (const auto& include : includes_below("protocols")) {
    EXPECT_FALSE(begins_with_any(include.target, {"server/", "tests/", "boost/", "spdlog/"})) << where(include);
  }
  for (const auto& include : includes_below("protocols/serial")) {
    EXPECT_FALSE(begins_with_any(include.target, {"nlohmann/", "protocols/web", "protocols/files"})) << where(include);
  }
  for (const auto& include : includes_below("server")) {
    EXPECT_FALSE(begins_with_any(include.target, {"tests/"})) << where(include);
  }
}

TEST(House, NobodyLocksAMutex) {
  for (const std::string folder : {"robot", "protocols", "server"}) {
    for (const auto& include : includes_below(folder)) {
      EXPECT_TRUE(include.target != "mutex" && include.target != "shared_mutex")
          << where(include) << ": values cross by one post";
    }
  }
}

TEST(House, EveryFolderSaysWhatLivesInIt) {
  for (const std::string top : {"robot", "protocols", "server", "tests", "static", "docker", "web"}) {
    EXPECT_TRUE(fs::exists(fs::path(top) / "README.md")) << top;
  }
  for (const std::string top : {"robot", "protocols", "server"}) {
    for (const auto& entry : fs::directory_iterator(top)) {
      if (!entry.is_directory() || fs::is_empty(entry.path())) continue;
      EXPECT_TRUE(fs::exists(entry.path() / "README.md")) << entry.path();
    }
  }
}

}  // namespace
