#pragma once
// Where results go.

#include <filesystem>
#include <initializer_list>
#include <string>

namespace echocine::fit {

class ResultsFolder {
 public:
  // Makes the folder, and removes `last`: one without them is unfinished. Throws JobError.
  ResultsFolder(std::filesystem::path folder, std::initializer_list<const char*> last);
  // Whole or not at all. Throws JobError.
  void write(const char* name, const std::string& content) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace echocine::fit
