// What is wrong with a file, where, and what to do about it.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace files {

struct Problem {
  std::string file;
  int line = 0;      // from 1; 0: the file as a whole
  std::string text;  // what is wrong
  std::string mend;  // what to change
};

// "file:line: text — mend", as compilers write it, so that editors can jump there.
inline std::string to_text(const Problem& problem) {
  const std::string place = problem.line > 0 ? problem.file + ":" + std::to_string(problem.line) : problem.file;
  return place + ": " + problem.text + (problem.mend.empty() ? "" : " — " + problem.mend);
}

// One thing is wrong and the file cannot be used.
class FileError : public std::runtime_error {
 public:
  explicit FileError(Problem problem) : std::runtime_error(to_text(problem)), problem_(std::move(problem)) {}
  const Problem& problem() const { return problem_; }

 private:
  Problem problem_;
};

}  // namespace files
