// The parts of HTTP that need no socket.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "server/http/files.hpp"
#include "server/http/router.hpp"
#include "server/http/url.hpp"
#include "tests/support/hostile_bytes.hpp"

using namespace server;

namespace {

TEST(Url, IsTakenApart) {
  const auto url = parse_target("/a%20b/c?x=1&y=%C3%A4+z&flag&=no");
  ASSERT_TRUE(url);
  EXPECT_EQ(url->path, "/a b/c");
  EXPECT_THAT(url->query,
              testing::ElementsAre(testing::Pair("x", "1"), testing::Pair("y", "ä z"), testing::Pair("flag", "")));
  EXPECT_EQ(parse_target("/")->path, "/");
  EXPECT_EQ(parse_target("/a+b")->path, "/a+b");
}

TEST(Url, IsRefusedWhenItClimbsOrLies) {
  for (const char* bad :
       {"",     "*",    "a",    "http://x/", "/..", "/../x", "/a/../b", "/%2e%2e/x", "/a/%2E%2e", "/.",       "/a\\b",
        "/%5c", "/%00", "/%0a", "/%",        "/%4", "/%zz",  "/x?y=%",  "/%ff",      "/%c0%af",   "/x?%fe=1", "/a#b"}) {
    EXPECT_FALSE(parse_target(bad)) << bad;
  }
  EXPECT_TRUE(parse_target("/..a/b..")) << "dots inside a name do not climb";
}

RC_GTEST_PROP(Url, NeverClimbsWhateverComes, ()) {
  const std::string target = *testing_support::damaged("/site/pictures/%2e%2e/a%2Fb?lang=de&x=%20");
  if (const auto url = parse_target(target)) {
    RC_ASSERT(url->path.starts_with('/'));
    RC_ASSERT(url->path.find("/../") == std::string::npos && !url->path.ends_with("/.."));
    RC_ASSERT(url->path.find('\0') == std::string::npos);
  }
}

TEST(Accept, KnowsRangesAndRefusals) {
  EXPECT_EQ(accepted_at("", "application/json"), 0u);
  EXPECT_EQ(accepted_at("text/html, application/*;q=0.5", "application/json"), 1u);
  EXPECT_EQ(accepted_at("*/*", "image/png"), 0u);
  EXPECT_EQ(accepted_at("text/html", "application/json"), std::nullopt);
  EXPECT_EQ(accepted_at("application/json;q=0", "application/json"), std::nullopt);
  EXPECT_TRUE(takes_encoding("gzip, br", "br"));
  EXPECT_FALSE(takes_encoding("gzip, br;q=0.0", "br"));
  EXPECT_FALSE(takes_encoding("", "gzip"));
  EXPECT_TRUE(matches_etag("\"a\", \"b\"", "\"b\""));
  EXPECT_TRUE(matches_etag("W/\"b\"", "\"b\""));
  EXPECT_FALSE(matches_etag("\"ab\"", "\"b\""));
}

}  // namespace
