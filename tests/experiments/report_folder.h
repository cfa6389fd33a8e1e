// A folder of results, and what the report reads of it.
#ifndef BATTEN_TESTS_EXPERIMENTS_REPORT_FOLDER_H_
#define BATTEN_TESTS_EXPERIMENTS_REPORT_FOLDER_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/report_document.h"

namespace batten {

inline constexpr char kTraceHeader[] =
    "iteration,energy_calls,gradient_calls,jacobian_calls,products,projections,seconds,cpu_seconds,"
    "energy,gradient_norm,step_norm,energy_interpolation\n";

class ReportFolder : public ::testing::Test {
 protected:
  ReportFolder() {
    std::string name = ::testing::TempDir() + "/batten_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~ReportFolder() override { std::filesystem::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(folder_ + "/" + name).parent_path());
    std::ofstream(folder_ + "/" + name, std::ios::binary) << text;
  }
  bool Read() { return ReadReportDocument(folder_, limits_, &document_, &error_); }
  nlohmann::json Summary() const { return nlohmann::json::parse(document_.summary); }
  nlohmann::json Traces() const { return nlohmann::json::parse(document_.traces); }
  nlohmann::json Curves() const { return nlohmann::json::parse(document_.curves); }

  std::string folder_;
  ReportLimits limits_;
  ReportDocument document_;
  std::string error_;
};

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_REPORT_FOLDER_H_
