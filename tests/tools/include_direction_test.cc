// Includes point one way: a folder may use those to its left in kFolders, never one to its right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <istream>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<std::string> kFolders = {"splines", "cost_functions", "problems",
                                           "solvers", "experiments",    "tools"};

// Place in kFolders; kFolders.size() for anything else, such as "ceres".
size_t Rank(const std::string& folder) {
  return std::find(kFolders.begin(), kFolders.end(), folder) - kFolders.begin();
}

std::string FirstFolder(const std::string& path) { return path.substr(0, path.find('/')); }

struct Include {
  int line;
  std::string path;
  bool quoted;
};

// The #include lines of `source`, in whatever spacing the preprocessor accepts.
std::vector<Include> ReadIncludes(std::istream& source) {
  std::vector<Include> includes;
  std::string text;
  for (int line = 1; std::getline(source, text); ++line) {
    std::istringstream words(text);
    char hash = 0;
    std::string directive;
    if (!(words >> hash) || hash != '#') continue;
    words >> std::ws;
    while (std::isalpha(words.peek()) != 0) directive += static_cast<char>(words.get());
    char open = 0;
    if (directive != "include" || !(words >> open) || (open != '"' && open != '<')) continue;
    std::string path;
    std::getline(words, path, open == '"' ? '"' : '>');
    includes.push_back({line, path, open == '"'});
  }
  return includes;
}

// One sentence for each include of `file` (a path from the root of the project) that breaks a rule.
std::vector<std::string> WrongIncludes(const std::string& file, std::istream& source) {
  std::vector<std::string> wrong;
  const std::string folder = FirstFolder(file);
  for (const Include& include : ReadIncludes(source)) {
    const std::string place = file + ":" + std::to_string(include.line) + ": ";
    const std::string target = FirstFolder(include.path);
    if (include.quoted && (target == include.path || target == "..")) {
      wrong.push_back(place + "\"" + include.path + "\" must be written from the root");
    } else if (Rank(target) < kFolders.size() && Rank(target) > Rank(folder)) {
      wrong.push_back(place + folder + " must not include \"" + include.path + "\"");
    } else if (file.rfind("experiments/audit", 0) == 0 && target == "splines") {
      wrong.push_back(place + "an audit must not share code with what it judges, \"" +
                      include.path + "\"");
    }
  }
  return wrong;
}

std::vector<std::string> WrongIncludesInText(const std::string& file, const std::string& text) {
  std::istringstream source(text);
  return WrongIncludes(file, source);
}

// The C++ files of the six folders, as paths from the root of the project.
std::vector<std::string> SourceFiles() {
  std::vector<std::string> files;
  const fs::path root = BATTEN_SOURCE_DIR;
  for (const std::string& folder : kFolders) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path extension = entry.path().extension();
      if (extension == ".h" || extension == ".cc") {
        files.push_back(fs::relative(entry.path(), root).generic_string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(IncludeDirection, PointsOneWayInEveryFile) {
  const std::vector<std::string> files = SourceFiles();
  ASSERT_FALSE(files.empty());
  for (const std::string& file : files) {
    std::ifstream source(fs::path(BATTEN_SOURCE_DIR) / file);
    ASSERT_TRUE(source.is_open()) << file;
    for (const std::string& sentence : WrongIncludes(file, source)) ADD_FAILURE() << sentence;
  }
}

TEST(IncludeDirection, CheckerNamesFileAndLineOfAWrongInclude) {
  EXPECT_THAT(WrongIncludesInText("cost_functions/fairing.cc",
                                  "#include <vector>\n"
                                  "#include \"cost_functions/fairing.h\"\n"
                                  "\n"
                                  "  #  include \"solvers/solver.h\"  // why not\n"
                                  "#include\"splines/bspline_basis.h\"\n"),
              ElementsAre("cost_functions/fairing.cc:4: cost_functions must not include "
                          "\"solvers/solver.h\""));
}

TEST(IncludeDirection, CheckerKnowsTheOrderOfEveryPairOfFolders) {
  for (size_t i = 0; i < kFolders.size(); ++i) {
    for (size_t j = 0; j < kFolders.size(); ++j) {
      for (const char* brackets : {"\"\"", "<>"}) {
        const std::string line =
            std::string("#include ") + brackets[0] + kFolders[j] + "/b.h" + brackets[1] + "\n";
        EXPECT_EQ(WrongIncludesInText(kFolders[i] + "/a.cc", line).size(), j > i ? 1u : 0u)
            << kFolders[i] << ": " << line;
      }
    }
  }
}

TEST(IncludeDirection, CheckerWantsPathsFromTheRoot) {
  EXPECT_THAT(WrongIncludesInText("splines/a.cc", "#include \"b.h\"\n"),
              ElementsAre(HasSubstr("splines/a.cc:1: \"b.h\" must be written from the root")));
  EXPECT_THAT(WrongIncludesInText("splines/a.cc", "#include \"../solvers/b.h\"\n"),
              ElementsAre(HasSubstr("must be written from the root")));
}

TEST(IncludeDirection, CheckerKeepsAuditsApartFromSplines) {
  const std::string line = "#include \"splines/bspline_curve.h\"\n";
  EXPECT_THAT(WrongIncludesInText("experiments/audit_energy.cc", line),
              ElementsAre(HasSubstr("experiments/audit_energy.cc:1: an audit must not")));
  EXPECT_THAT(WrongIncludesInText("experiments/run_control.cc", line), IsEmpty());
}

TEST(IncludeDirection, CheckerPassesLibrariesAndComments) {
  EXPECT_THAT(WrongIncludesInText("splines/a.cc",
                                  "#include <ceres/jet.h>\n"
                                  "#include \"ceres/jet.h\"\n"
                                  "// #include \"solvers/solver.h\"\n"
                                  "#ifdef X\n"),
              IsEmpty());
}

}  // namespace
