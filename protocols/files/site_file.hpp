// A museum's folder: site.toml beside its map, pictures and sounds. Degrees in the file, radians from here on.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "protocols/files/problem.hpp"
#include "robot/body.hpp"
#include "robot/museum.hpp"

namespace files {

// Everything that is wrong with a museum's files.
class SiteError : public std::runtime_error {
 public:
  explicit SiteError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// Reads <dir>/site.toml with the map it names. Throws SiteError with all problems that check_site finds.
robot::Museum load_site(const std::filesystem::path& dir);

// All that is wrong: unreadable or missing values, ids used twice, languages left out, tours through unknown exhibits,
// polygons that are none, pictures that are not there, and places where the robot cannot stand or that it cannot reach
// from its homing position. Empty: the museum is sound.
std::vector<Problem> check_site(const std::filesystem::path& dir,
                                const robot::Footprint& footprint = robot::standard_body().footprint);

}  // namespace files
