// The examples of the README, run as they stand against the real server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include "tests/support/http_client.hpp"
#include "tests/support/server_process.hpp"

namespace {

using testing_support::HttpClient;
using testing_support::ServerProcess;
using testing_support::TemporaryFolder;

// The fenced block that begins with this line, spoken to another port than the README's.
std::string example(const std::string& language, const std::string& first_line, unsigned short port) {
  std::ifstream file("README.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto begin = text.find("```" + language + "\n" + first_line);
  if (begin == std::string::npos) return "";
  const auto body = begin + 4 + language.size();
  std::string code = text.substr(body, text.find("\n```", body) - body + 1);
  for (auto at = code.find(":8080"); at != std::string::npos; at = code.find(":8080")) {
    code.replace(at, 5, ":" + std::to_string(port));
  }
  return code;
}

// Standard output of a program that is given `code` as its first argument's file.
std::string run(const TemporaryFolder& folder, const std::string& program, const std::string& code) {
  const auto path = folder.path() / "example";
  std::ofstream(path) << code;
  std::string out;
  FILE* pipe = popen((program + " " + path.string() + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (pipe && fgets(buffer.data(), buffer.size(), pipe)) out += buffer.data();
  EXPECT_EQ(pipe ? pclose(pipe) : -1, 0) << out;
  return out;
}

class ReadmeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    HttpClient client(server_.port());
    for (int i = 0; i < 300; ++i) {
      if (client.get("/readyz").status == 200) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    FAIL() << server_.log();
  }
  TemporaryFolder folder_;
  ServerProcess server_{folder_, {"--visitors=5"}};
};

TEST_F(ReadmeTest, CurlExampleAsksForAnExhibit) {
  const std::string code = example("sh", "# curl", server_.port());
  ASSERT_FALSE(code.empty()) << "the README has no curl example any more";
  const std::string out = run(folder_, "sh -e", code);
  EXPECT_THAT(out, ::testing::HasSubstr("\"beam-engine\""));
  EXPECT_THAT(out, ::testing::HasSubstr("\"name\":\"Ada\""));
  EXPECT_THAT(out, ::testing::HasSubstr("\"sentence\""));
}

TEST_F(ReadmeTest, PythonExampleWaitsUntilTheRobotIsOnItsWay) {
  const std::string code = example("python", "# python", server_.port());
  ASSERT_FALSE(code.empty()) << "the README has no Python example any more";
  EXPECT_THAT(run(folder_, "python3", code), ::testing::StartsWith("I "));
}

}  // namespace
