// Who is who: a random cookie in the browser, and what is known of it here. The cookie itself stays a secret between
// the two; everything else (requests, recordings, the database) knows only its hash. Belongs to the web thread.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "server/stream/asio.hpp"
#include "server/stream/token_bucket.hpp"

namespace server {

inline constexpr const char* session_cookie = "docent_session";

// 128 random bits in hexadecimal.
std::string new_cookie();
// The public id of a cookie; none when it is not one of ours by its form.
std::optional<std::string> session_of(std::string_view cookie);
// The value of a cookie in a Cookie header, or empty.
std::string_view cookie_value(std::string_view header, std::string_view name);

// Checks a password against what was configured: plain text, or an argon2 string ("$argon2id$..."), in constant time.
bool password_matches(const std::string& configured, const std::string& given);

struct SessionLimits {
  Rate per_session;
  Rate per_address;
  Rate passwords;
  std::size_t sessions = 100'000;
};

class Sessions {
 public:
  explicit Sessions(SessionLimits limits) : limits_(limits) {}

  const std::string& name(const std::string& session);
  void set_name(const std::string& session, std::string name);
  // Staff for twelve hours from now.
  void make_staff(const std::string& session, Clock::time_point now);
  bool is_staff(const std::string& session, Clock::time_point now);

  // Seconds to wait before another change may be asked for; 0: now, and it counts.
  int admit_change(const std::string& session, const net::ip::address& address, Clock::time_point now);
  int admit_password(const net::ip::address& address, Clock::time_point now);
  // Forgets addresses that have been quiet. Call now and then.
  void tidy(Clock::time_point now);

 private:
  struct Session {
    std::string id;
    std::string name;
    Clock::time_point staff_until{};
    TokenBucket changes;
  };
  struct Address {
    TokenBucket changes;
    TokenBucket passwords;
  };
  Session& get(const std::string& id);
  Address& get(const net::ip::address& address, Clock::time_point now);

  SessionLimits limits_;
  std::list<Session> sessions_;  // the one used last in front
  std::unordered_map<std::string, std::list<Session>::iterator> by_id_;
  std::map<net::ip::address, Address> addresses_;
};

}  // namespace server
