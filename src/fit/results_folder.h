#pragma once
// The folder of results.

#include <filesystem>
#include <initializer_list>
#include <string>

namespace echocine::fit {

class ResultsFolder {
 public:
  // Makes the folder, and removes the files `last`: a folder without them is unfinished. Throws
  // JobError.
  ResultsFolder(std::filesystem::path folder, std::initializer_list<const char*> last);
  // Writes the whole file or none. Throws JobError.
  void write(const char* name, const std::string& content) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace echocine::fit
