#ifndef BATTEN_TESTS_EXPERIMENTS_FIGURE_FILES_H_
#define BATTEN_TESTS_EXPERIMENTS_FIGURE_FILES_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/gnuplot.h"

namespace batten {

/// An empty folder of its own.
inline std::filesystem::path Folder(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("batten figures " + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string Contents(const std::filesystem::path& path) {
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The lines of a data file that are not comments, block by block.
inline std::vector<std::vector<std::string>> Blocks(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> blocks(1);
  std::istringstream stream(Contents(path));
  std::string line;
  while (std::getline(stream, line)) {
    if (line.empty() && !blocks.back().empty()) blocks.emplace_back();
    if (!line.empty() && line[0] != '#') blocks.back().push_back(line);
  }
  return blocks;
}

/// What FitFigure or ConvergenceFigure makes, with all of its files in their places.
template <typename Draw>
FigureResult Committed(const Draw& draw) {
  FileBatch batch;
  FigureResult result = draw(&batch);
  std::string error;
  if (result.message.rfind("cannot write", 0) != 0) {
    EXPECT_TRUE(batch.Commit(&error)) << error;
  }
  return result;
}

/// Without gnuplot there is no picture to look at: the tests below then look at what is left.
inline bool HasGnuplot() { return std::system("gnuplot --version > /dev/null 2>&1") == 0; }

inline void ExpectDrawn(const FigureResult& result, const std::string& stem) {
  EXPECT_TRUE(result.written) << result.message;
  EXPECT_TRUE(std::filesystem::exists(stem + ".dat"));
  EXPECT_TRUE(std::filesystem::exists(stem + ".gp"));
  if (!HasGnuplot()) GTEST_SKIP() << "no gnuplot";
  EXPECT_TRUE(result.drawn) << result.message;
  EXPECT_EQ(result.message, "");
  EXPECT_THAT(Contents(stem + ".svg"), ::testing::StartsWith("<?xml"));
  EXPECT_THAT(Contents(stem + ".svg"), ::testing::HasSubstr("</svg>"));
}

}  // namespace batten

#endif  // BATTEN_TESTS_EXPERIMENTS_FIGURE_FILES_H_
