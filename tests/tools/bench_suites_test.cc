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
                 {"/solvers/2/options/memory"}},
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
                 {"/seeds/data/2: found 2; allowed: each number once"}},
        BadSuite{"GapTwice",
                 [](json* s) {
                   (*s)["targets"] = {{"gaps", {0.1, 0.1}}};
                 },
                 {"/targets/gaps/1: found 0.1; allowed: each number once"}},
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
                 [](json* s) {
                   (*s)["budgets"] = {{"second", 1}};
                 },
                 {"/budgets", "did you mean seconds?"}},
        BadSuite{"ModeWord",
                 [](json* s) {
                   (*s)["rule"] = {{"mode", "rase"}};
                 },
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
                 [](json* s) {
                   (*s)["targets"] = {{"gaps", {0.1, 2}}};
                 },
                 {"/targets/gaps/1: found 2"}},
        BadSuite{"Seeds",
                 [](json* s) {
                   (*s)["seeds"] = {{"start", {1, 1.5}}};
                 },
                 {"/seeds/start/1: found 1.5"}},
        BadSuite{"ExclusionOfNothing",
                 [](json* s) {
                   (*s)["exclude"] = {{{"solvers", {"cg", "gmi"}}}};
                 },
                 {"/exclude/0/solvers/1: unknown solver \"gmi\"", "did you mean "}},
        BadSuite{"ExclusionOfNoProblem",
                 [](json* s) {
                   (*s)["exclude"] = {{{"solvers", {"*"}}, {"problems", {"wev*"}}}};
                 },
                 {"/exclude/0/problems/0: unknown problem \"wev*\""}},
        BadSuite{"ExclusionOfAll",
                 [](json* s) {
                   (*s)["exclude"] = {{{"solvers", {"*"}}}};
                 },
                 {"/exclude: leaves nothing to run"}}),
    [](const auto& bad) { return std::string(bad.param.name); });

}  // namespace
}  // namespace batten
