// Suites that `bench` refuses.
#include <functional>

#include "tests/tools/bench_fixture.h"

namespace batten {
namespace {

using nlohmann::json;

struct BadSuite {
  const char* name;
  std::function<void(json*)> spoil;
  std::vector<std::string> parts;  // of the message
};
void PrintTo(const BadSuite& bad, std::ostream* stream) { *stream << bad.name; }

class BadSuites : public Bench, public ::testing::WithParamInterface<BadSuite> {};

TEST_P(BadSuites, GetOneLineWithThePath) {
  json suite = GoodSuite();
  GetParam().spoil(&suite);
  std::vector<std::string> parts = GetParam().parts;
  parts.push_back("suite.json: /");
  ExpectRefused(RunBatten({"bench", Suite(suite), "--out=" + (folder_ / "out")}), parts);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

INSTANTIATE_TEST_SUITE_P(
    BenchCommand, BadSuites,
    ::testing::Values(
        BadSuite{"UnknownKey",
                 [](json* s) { (*s)["repetition"] = 3; },
                 {"unknown key", "did you mean repetitions?"}},
        BadSuite{"NoFormat", [](json* s) { s->erase("format"); }, {"/format: found nothing"}},
        BadSuite{"WrongType",
                 [](json* s) { (*s)["repetitions"] = "five"; },
                 {"/repetitions: found \"five\"; allowed: 1 to 1000"}},
        BadSuite{"NoProblems",
                 [](json* s) { (*s)["problems"] = json::array(); },
                 {"/problems: found an empty list"}},
        BadSuite{"ProblemUnknown",
                 [](json* s) { (*s)["problems"][0] = "rihno"; },
                 {"/problems/0", "did you mean rhino?"}},
        BadSuite{"FlagOfASyntheticProblem",
                 [](json* s) { (*s)["problems"][0]["hold_ends"] = "yes"; },
                 {"/problems/0/hold_ends: found \"yes\""}},
        BadSuite{"KindInAList",
                 [](json* s) {
                   (*s)["problems"][0]["parameter_kind"] = {"free", "fixd"};
                 },
                 {"/problems/0/parameter_kind/1", "did you mean fixed?"}},
        BadSuite{"WordForTheUsualTerm",
                 [](json* s) { (*s)["terms"] = {"distnace"}; },
                 {"/terms/0", "did you mean distance?"}},
        BadSuite{"WordForTheProblemsTerms",
                 [](json* s) { (*s)["terms"] = {"onw"}; },
                 {"/terms/0", "did you mean own?"}},
        BadSuite{"WordForAllSolvers",
                 [](json* s) { (*s)["solvers"] = {"al"}; },
                 {"/solvers/0", "did you mean all?"}},
        BadSuite{"ProblemKey",
                 [](json* s) { (*s)["problems"][0]["point"] = 3; },
                 {"/problems/0", "did you mean points?"}},
        BadSuite{
            "MissingFile",
            [](json* s) {
              (*s)["problems"][0] = {{"data", "no/such.csv"}, {"name", "x"}, {"control_points", 9}};
            },
            {"/problems/0/data: found \"no/such.csv\"; allowed: a file in"}},
        BadSuite{"EmptyGrid",
                 [](json* s) { (*s)["problems"][0]["control_points"] = json::array(); },
                 {"/problems/0/control_points: found an empty list"}},
        BadSuite{"GridValue",
                 [](json* s) {
                   (*s)["problems"][0]["control_points"] = {8, -3};
                 },
                 {"/problems/0/control_points/1: found -3"}},
        BadSuite{"GridValueTwice",
                 [](json* s) {
                   (*s)["problems"][0]["control_points"] = {8, 12, 8};
                 },
                 {"/problems/0/control_points/2: found 8; allowed: each value once"}},
        BadSuite{"KindTwice",
                 [](json* s) {
                   (*s)["problems"][0]["parameter_kind"] = {"free", "free"};
                 },
                 {"/problems/0/parameter_kind/1: found \"free\"; allowed: each value once"}},
        BadSuite{"ProblemNumber",
                 [](json* s) { (*s)["problems"][0] = 3; },
                 {"/problems/0: found 3; allowed: a name of the catalogue, a problem file, or an "
                  "object"}},
        BadSuite{"TooFewControlPoints",
                 [](json* s) { (*s)["problems"][1]["control_points"] = 2; },
                 {"/problems/1/control_points: found 2; allowed: more than the degree, 3"}},
        BadSuite{"SolverUnknown",
                 [](json* s) { (*s)["solvers"][1] = "gc"; },
                 {"/solvers/1", "did you mean cg?"}},
        BadSuite{"SolverOption",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memry", {3}}};
                 },
                 {"/solvers/2/options/memry", "memory"}},
        BadSuite{"SolverOptionRange",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memory", {3, 0}}};
                 },
                 {"/solvers/2/options/memory/1: option memory of lbfgs is 0"}},
        BadSuite{"SolverOptionTwice",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memory", {3, "3"}}};
                 },
                 {"/solvers/2/options/memory/1: found \"3\"; allowed: each value once"}},
        BadSuite{"SolverOptionType",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memory", {3, true}}};
                 },
                 {"/solvers/2/options/memory/1: found true; allowed: a number or a word"}},
        BadSuite{"SolverOptionWord",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"wolfe", {"weak", "strnog"}}};
                 },
                 {"/solvers/2/options/wolfe/1: ", "did you mean strong?"}},
        BadSuite{"SolverOptionOfTwoLines",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"wolfe", "we\nak"}};
                 },
                 {"/solvers/2/options/wolfe: found \"we\\nak\"; allowed: a number or a word"}},
        BadSuite{"SolverOptionWithASlash",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"mem\n/ory", true}};
                 },
                 {"/solvers/2/options/mem?/ory: lbfgs has no option", "did you mean memory"}},
        BadSuite{"SolverOptionInTheText",
                 [](json* s) {
                   (*s)["solvers"][2] = {{"solver", "lbfgs/memory=0"},
                                         {"options", {{"wolfe", {"weak"}}}}};
                 },
                 {"/solvers/2/solver: option memory of lbfgs is 0"}},
        BadSuite{"SolverOptionInTextAndGrid",
                 [](json* s) { (*s)["solvers"][2]["solver"] = "lbfgs/memory=3"; },
                 {"/solvers/2/options/memory: found a list; allowed: nothing, where `solver` has "
                  "memory=3"}},
        BadSuite{"SolverThatWrapsAlready",
                 [](json* s) {
                   (*s)["solvers"][2] = {{"solver", "anderson:lspia"}, {"wraps", {"pdm"}}};
                 },
                 {"/solvers/2/wraps: found a list; allowed: nothing, where `solver` wraps lspia"}},
        BadSuite{"SolverNumber",
                 [](json* s) { (*s)["solvers"][1] = 3; },
                 {"/solvers/1: found 3; allowed: a name with options, all, or an object"}},
        BadSuite{"LongerThanItsProcess",
                 [](json* s) { (*s)["budgets"]["wall_seconds"] = 10; },
                 {"/budgets/seconds: found 20; allowed: at most wall_seconds, 10"}},
        BadSuite{"EmptyOptionGrid",
                 [](json* s) {
                   (*s)["solvers"][2]["options"] = {{"memory", json::array()}};
                 },
                 {"/solvers/2/options/memory: found an empty list"}},
        BadSuite{"SolverTwice",
                 [](json* s) { (*s)["solvers"][0] = "lbfgs"; },
                 {"/solvers/2: found lbfgs/memory=10 twice"}},
        BadSuite{"SeedTwice",
                 [](json* s) {
                   (*s)["seeds"] = {{"data", {2, 1, 2}}};
                 },
                 {"/seeds/data/2: found 2; allowed: each value once"}},
        BadSuite{"GapTwice",
                 [](json* s) {
                   (*s)["targets"] = {{"gaps", {0.1, 0.1}}};
                 },
                 {"/targets/gaps/1: found 0.1; allowed: each value once"}},
        BadSuite{"Term",
                 [](json* s) { (*s)["terms"] = {"distance,fairnig"}; },
                 {"/terms/0", "did you mean fairing?"}},
        BadSuite{"TermsTwiceByTheirMeaning",
                 [](json* s) {
                   (*s)["terms"] = {"distance", "distance,fairing/weight=1e-4", "interpolation"};
                 },
                 {"/terms/2: found interpolation, on every problem here the same as distance of "
                  "/terms/0; allowed: each choice of terms once"}},
        BadSuite{"OwnTermsTwice",
                 [](json* s) {
                   (*s)["terms"] = {"own", "interpolation/weight=1"};
                 },
                 {"/terms/1: found interpolation/weight=1, on every problem here the same as own"}},
        BadSuite{"TermsTwiceInAnotherOrder",
                 [](json* s) {
                   (*s)["terms"] = {"distance,fairing/weight=1e-4", "fairing/weight=1e-4,distance"};
                 },
                 {"/terms/1: found fairing/weight=1e-4+distance, on every problem"}},
        BadSuite{"NegativeBudget",
                 [](json* s) { (*s)["budgets"]["seconds"] = -1; },
                 {"/budgets/seconds: found -1; allowed: 0.001 to"}},
        BadSuite{"BudgetKey",
                 [](json* s) { (*s)["budgets"] = {{"second", 1}}; },
                 {"/budgets", "did you mean seconds?"}},
        BadSuite{"ModeWord",
                 [](json* s) { (*s)["rule"] = {{"mode", "rase"}}; },
                 {"/rule/mode", "did you mean race?"}},
        BadSuite{"OneIterate",
                 [](json* s) { (*s)["keep_iterates"] = 1; },
                 {"/keep_iterates: found 1; allowed: all, 0, or 2 to 1000"}},
        BadSuite{"IteratesWord",
                 [](json* s) { (*s)["keep_iterates"] = "most"; },
                 {"/keep_iterates: found \"most\"; allowed: all, 0, or 2 to 1000"}},
        BadSuite{"IteratesFlag",
                 [](json* s) { (*s)["keep_iterates"] = true; },
                 {"/keep_iterates: found true"}},
        BadSuite{"Target",
                 [](json* s) { (*s)["targets"] = {{"gaps", {0.1, 2}}}; },
                 {"/targets/gaps/1: found 2"}},
        BadSuite{"Seeds",
                 [](json* s) { (*s)["seeds"] = {{"start", {1, 1.5}}}; },
                 {"/seeds/start/1: found 1.5"}},
        BadSuite{"ExclusionOfNothing",
                 [](json* s) { (*s)["exclude"] = {{{"solvers", {"cg", "gmi"}}}}; },
                 {"/exclude/0/solvers/1: unknown solver \"gmi\"", "did you mean "}},
        BadSuite{"ExclusionOfNoProblem",
                 [](json* s) { (*s)["exclude"] = {{{"solvers", {"*"}}, {"problems", {"wev*"}}}}; },
                 {"/exclude/0/problems/0: unknown problem \"wev*\""}},
        BadSuite{"ExclusionOfAll",
                 [](json* s) { (*s)["exclude"] = {{{"solvers", {"*"}}}}; },
                 {"/exclude: leaves nothing to run"}}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST_F(Bench, RefusesANumberThatIsTooLargeWithItsPlace) {
  std::string text = GoodSuite().dump();
  const std::string seconds = "\"seconds\":20";
  text.replace(text.find(seconds), seconds.size(), "\"seconds\":1e999");
  ExpectRefused(RunBatten({"bench", folder_.Write("suite.json", text), "--dry_run"}),
                {"suite.json: /budgets/seconds: found 1e999; allowed: numbers of at most 1.79"});
  text = GoodSuite().dump();
  const std::string grid = "[3,10]";
  text.replace(text.find(grid), grid.size(), "[3,-1e400]");
  ExpectRefused(RunBatten({"bench", folder_.Write("suite.json", text), "--dry_run"}),
                {"suite.json: /solvers/2/options/memory/1: found -1e400; allowed: numbers"});
}

}  // namespace
}  // namespace batten
