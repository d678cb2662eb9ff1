#include "server/api/sessions.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace server {
namespace {

constexpr std::size_t cookie_bytes = 16;

void need_sodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium does not start");
}

template <std::size_t N>
std::string hex(const std::array<unsigned char, N>& bytes) {
  std::string text(2 * N + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), bytes.data(), N);
  text.pop_back();
  return text;
}

std::array<unsigned char, 32> hash(std::string_view text) {
  std::array<unsigned char, 32> digest;
  crypto_generichash(digest.data(), digest.size(), reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                     nullptr, 0);
  return digest;
}

}  // namespace

std::string new_cookie() {
  need_sodium();
  std::array<unsigned char, cookie_bytes> bytes;
  randombytes_buf(bytes.data(), bytes.size());
  return hex(bytes);
}

std::optional<std::string> session_of(std::string_view cookie) {
  const bool well_formed = cookie.size() == 2 * cookie_bytes && std::all_of(cookie.begin(), cookie.end(), [](char c) {
                             return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
                           });
  if (!well_formed) return std::nullopt;
  return hex(hash(cookie)).substr(0, 32);
}

std::string_view cookie_value(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view pair = header.substr(0, end);
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
      return pair.substr(name.size() + 1);
    header.remove_prefix(std::min(end + 1, header.size()));
  }
  return {};
}

bool password_matches(const std::string& configured, const std::string& given) {
  need_sodium();
  if (configured.empty()) return false;
  if (configured.starts_with("$argon2")) {
    return crypto_pwhash_str_verify(configured.c_str(), given.data(), given.size()) == 0;
  }
  const auto a = hash(configured), b = hash(given);
  return sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

Sessions::Session& Sessions::get(const std::string& id) {
  if (const auto it = by_id_.find(id); it != by_id_.end()) {
    sessions_.splice(sessions_.begin(), sessions_, it->second);
    return *it->second;
  }
  if (sessions_.size() >= limits_.sessions) {
    by_id_.erase(sessions_.back().id);
    sessions_.pop_back();
  }
  sessions_.push_front({id, {}, {}, TokenBucket(limits_.per_session, Clock::now())});
  by_id_[id] = sessions_.begin();
  return sessions_.front();
}

Sessions::Address& Sessions::get(const net::ip::address& address, Clock::time_point now) {
  // An IPv6 customer has a whole /64.
  net::ip::address key = address;
  if (address.is_v6()) {
    auto bytes = address.to_v6().to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    key = net::ip::address_v6(bytes);
  }
  const auto it = addresses_.find(key);
  if (it != addresses_.end()) return it->second;
  return addresses_.emplace(key, Address{TokenBucket(limits_.per_address, now), TokenBucket(limits_.passwords, now)})
      .first->second;
}

const std::string& Sessions::name(const std::string& session) { return get(session).name; }

void Sessions::set_name(const std::string& session, std::string name) { get(session).name = std::move(name); }

void Sessions::make_staff(const std::string& session, Clock::time_point now) {
  get(session).staff_until = now + std::chrono::hours(12);
}

bool Sessions::is_staff(const std::string& session, Clock::time_point now) {
  const auto it = by_id_.find(session);
  return it != by_id_.end() && it->second->staff_until > now;
}

int Sessions::admit_change(const std::string& session, const net::ip::address& address, Clock::time_point now) {
  Address& from = get(address, now);
  if (!from.changes.take(now)) return from.changes.wait_seconds(now);
  Session& who = get(session);
  return who.changes.take(now) ? 0 : who.changes.wait_seconds(now);
}

int Sessions::admit_password(const net::ip::address& address, Clock::time_point now) {
  Address& from = get(address, now);
  return from.passwords.take(now) ? 0 : from.passwords.wait_seconds(now);
}

void Sessions::tidy(Clock::time_point now) {
  std::erase_if(addresses_,
                [&](const auto& entry) { return entry.second.changes.full(now) && entry.second.passwords.full(now); });
}

}  // namespace server
