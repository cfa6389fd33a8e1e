// `batten new`: what it writes and refuses. That what it writes builds and passes is tried where
// the installed package is (.ci/run).
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// Runs in `folder`, as `new` writes into the folder that it is called in.
Ended NewIn(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  std::vector<std::string> all = {"new"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Ended ended = RunBatten(all);
  std::filesystem::current_path(before);
  return ended;
}

TEST(New, WritesASolverAndATerm) {
  const TemporaryFolder folder;
  for (const std::string kind : {"solver", "term"}) {
    const std::string name = "my_" + kind;
    const Ended ended = NewIn(folder, {kind, name});
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("batten check " + name + "/build/" + name + ".so"));
    const std::string source = ReadFile(folder / (name + "/" + name + ".cc"));
    EXPECT_THAT(source, HasSubstr(kind == "solver" ? "struct MySolver" : "struct MyTerm"));
    EXPECT_THAT(source, HasSubstr("\"" + name + "\""));
    EXPECT_LE(std::count(source.begin(), source.end(), '\n'), kind == "solver" ? 30 : 20);
    const std::string build = ReadFile(folder / (name + "/CMakeLists.txt"));
    EXPECT_THAT(build, HasSubstr("batten_add_plugin(" + name + " " + name + ".cc)"));
    EXPECT_THAT(build, HasSubstr("add_test(NAME conformance"));
    EXPECT_THAT(source + build, Not(HasSubstr("@")));
  }
  EXPECT_THAT(folder.Names(), ElementsAre("my_solver", "my_term"));
}

TEST(New, NamesNoClassLikeSomethingThatTheSourceUses) {
  for (const auto& [kind, name, class_name] :
       {std::tuple{"solver", "eigen", "EigenSolver"},
        {"term", "eigen", "EigenTerm"},
        {"solver", "simple_stepper", "SimpleStepperSolver"},
        {"term", "term_at_data_points", "TermAtDataPointsTerm"},
        {"term", "t", "TTerm"},
        {"solver", "my_method", "MyMethodSolver"},
        {"solver", "solver", "SolverSolver"}}) {
    const TemporaryFolder place;
    ASSERT_EQ(NewIn(place, {kind, name}).status, 0) << name;
    const std::string source = ReadFile(place / (std::string(name) + "/" + name + ".cc"));
    EXPECT_THAT(source, HasSubstr("struct " + std::string(class_name) + " "));
  }
}

TEST(New, RefusesBadNamesAndWritesNothing) {
  const TemporaryFolder folder;
  for (const std::string name :
       {"", "Mine", "9lives", "a b", "a/b", "../a", "a-b", "a_", "a__b", "_a", "x\ny", "\xc3\xa4",
        "abcdefghijklmnopqrstuvwxyzabcdefghijklmnopq"}) {
    ExpectRefused(NewIn(folder, {"solver", name}), {"new: found ", "allowed: a lower-case letter"});
  }
  ExpectRefused(NewIn(folder, {"solver", "test"}), {"one of CMake's own"});
  ExpectRefused(NewIn(folder, {"solver", "ceres"}), {"a library that Batten needs"});
  ExpectRefused(NewIn(folder, {"term", "distance"}), {"has a meaning in suites"});
  ExpectRefused(NewIn(folder, {"term", "own"}), {"has a meaning in suites"});
  ExpectRefused(NewIn(folder, {"solver", "lbfgs"}), {"a solver or term already"});
  ExpectRefused(NewIn(folder, {"term", "fairing"}), {"a solver or term already"});
  ExpectRefused(NewIn(folder, {"solvr", "mine"}),
                {"unknown kind \"solvr\"", "did you mean solver"});
  ExpectRefused(NewIn(folder, {"solver"}), {"found 1 words; allowed: solver NAME, term NAME"});
  EXPECT_THAT(folder.Names(), ElementsAre());
}

TEST(New, LeavesWhatIsThere) {
  const TemporaryFolder folder;
  folder.Write("mine", "precious");
  ExpectRefused(NewIn(folder, {"solver", "mine"}), {"mine is there already"});
  EXPECT_EQ(ReadFile(folder / "mine"), "precious");
  std::filesystem::create_directory(folder / "full");
  ExpectRefused(NewIn(folder, {"term", "full"}), {"full is there already"});
  std::filesystem::create_symlink("nowhere", folder / "link");
  ExpectRefused(NewIn(folder, {"term", "link"}), {"link is there already"});
  EXPECT_THAT(folder.Names(), ElementsAre("full", "link", "mine"));
}

}  // namespace
}  // namespace batten
