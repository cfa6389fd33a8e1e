// Flags as the program takes and refuses them.
#include <gmock/gmock.h>

#include "tests/tools/program.h"

namespace batten {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Ended Fit(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "fit");
  return RunBatten(std::move(arguments), kSixPoints);
}

TEST(Flags, AnswerANumberOutsideItsRangeWithTheRange) {
  const Ended ended = Fit({"-", "--control_points=5", "--degree=12"});
  ExpectRefused(ended, {});
  EXPECT_EQ(ended.err, "--degree: found 12; allowed: 1 to 9\n");
}

TEST(Flags, RefuseWhatIsNoNumberOfControlPoints) {
  for (const std::string value : {"1e12", "0", "-1"}) {
    ExpectRefused(Fit({"-", "--control_points=" + value}),
                  {"--control_points: found " + value, "allowed: 1 to 10000000"});
  }
  for (const std::string value : {"abc", "", "nan", "inf", "5x", "0x10"}) {
    ExpectRefused(Fit({"-", "--control_points=" + value}),
                  {"--control_points: found \"" + value + "\"", "allowed: 1 to 10000000"});
  }
  ExpectRefused(Fit({"-", "--control_points=4.5"}), {"found 4.5", "whole numbers"});
  ExpectRefused(Fit({"-", "--control_points=3"}), {"found 3", "4 to 10000000", "open curve"});
  ExpectRefused(Fit({"-"}), {"--control_points", "allowed: 4 to"});
  ExpectRefused(Fit({"-", "--control_points"}), {"--control_points: found \"\""});
}

TEST(Flags, RefuseValuesOutsideTheRangesOfTheRun) {
  ExpectRefused(Fit({"-", "--gradient_tolerance=2"}), {"--gradient_tolerance: found 2", "0 to 1"});
  ExpectRefused(Fit({"-", "--max_seconds=0"}), {"--max_seconds: found 0", "above 0"});
  ExpectRefused(Fit({"-", "--max_iterations=-1"}), {"--max_iterations: found -1", "0 to"});
  ExpectRefused(Fit({"-", "--threads=0"}), {"--threads: found 0", "1 to"});
  ExpectRefused(Fit({"-", "--seed=-5"}), {"--seed: found -5", "0 to"});
  ExpectRefused(Fit({"-", "--native_step=-1e-3"}), {"--native_step: found -1e-3", "at least 0"});
  ExpectRefused(Fit({"-", "--mode=rase"}), {"--mode: found \"rase\"", "race, native"});
  ExpectRefused(Fit({"-", "--closed=maybe"}), {"--closed: found \"maybe\"", "true, false"});
  ExpectRefused(RunBatten({"compare", "--repetitions=0"}), {"--repetitions: found 0", "1 to"});
}

TEST(Flags, RefuseSeedsThatADoubleWouldRound) {
  ExpectRefused(Fit({"-", "--seed=9007199254740993"}),
                {"--seed: found 9007199254740993", "0 to 9007199254740991"});
  ExpectRefused(Fit({"-", "--seed=9007199254740992"}), {"--seed"});
  EXPECT_EQ(Fit({"-", "--control_points=5", "--seed=9007199254740991"}).status, 0);
}

TEST(Flags, AnswerAnEmptyTextWithWhatIsAllowed) {
  ExpectRefused(Fit({"-", "--knots="}), {"--knots: found \"\"", "uniform, averaged, numbers"});
  ExpectRefused(Fit({"-", "--solver="}), {"--solver: found \"\"", "batten list solvers"});
  ExpectRefused(Fit({"-", "--terms="}), {"--terms: found \"\"", "batten list terms"});
  ExpectRefused(Fit({"-", "--domain="}), {"--domain: found \"\"", "A < B"});
  ExpectRefused(Fit({"--problem="}), {"--problem: found \"\"", "batten list problems"});
  ExpectRefused(Fit({"-", "--out="}), {"--out: found \"\"", "a file"});
  ExpectRefused(RunBatten({"compare", "--problems="}), {"--problems: ", "batten list problems"});
  ExpectRefused(RunBatten({"compare", "--solvers="}), {"--solvers: ", "batten list solvers"});
  ExpectRefused(RunBatten({"compare", "--out="}), {"--out: found \"\"", "a folder"});
}

TEST(Flags, AnswerAnUnknownOneWithTheNearestOfTheCommand) {
  ExpectRefused(Fit({"-", "--contrl_points=4"}),
                {"--contrl_points: unknown flag", "did you mean --control_points?"});
  ExpectRefused(RunBatten({"compare", "--control_points=4"}), {"unknown flag"});
  ExpectRefused(RunBatten({"list", "--jsn"}), {"did you mean --json?"});
  ExpectRefused(Fit({"-", "--nodegree"}), {"unknown flag"});
}

TEST(Flags, AnswerAMisspeltWordOfAnOptionWithTheNearest) {
  ExpectRefused(RunBatten({"fit", "--problem=rhino", "--solver=lspia/step=diagnal"}),
                {"option step of lspia is diagnal", "did you mean diagonal?"});
  ExpectRefused(RunBatten({"fit", "--problem=rhino", "--terms=interpolation/loss=hubber"}),
                {"did you mean huber?"});
  ExpectRefused(RunBatten({"compare", "--problems=rhino", "--solvers=cg,lbfgs/wolfe=srtong"}),
                {"did you mean strong?"});
  // Numbers have no nearest one.
  const Ended ended = RunBatten({"fit", "--problem=rhino", "--solver=lbfgs/memory=x"});
  ExpectRefused(ended, {"option memory of lbfgs is x"});
  EXPECT_EQ(ended.err.find("did you mean"), std::string::npos);
}

TEST(Flags, DoNotKnowThoseOfTheLibrariesBehindThem) {
  for (const std::string flag : {"flagfile=/dev/null", "fromenv=degree", "undefok=x", "helpfull",
                                 "minloglevel=0", "v=3", "logtostderr", "helpxml"}) {
    ExpectRefused(Fit({"-", "--control_points=4", "--" + flag}), {"unknown flag"});
  }
}

TEST(Flags, AreTakenInAllUsualForms) {
  for (const std::vector<std::string>& form : {std::vector<std::string>{"--control_points=5"},
                                               {"--control_points", "5"},
                                               {"-control_points=5"},
                                               {"-control_points", "5"},
                                               {"--control_points=5e0"},
                                               {"--control_points=9", "--control_points=5"},
                                               {"--closed", "--noclosed", "--control_points=5"},
                                               {"--closed=false", "--control_points=5"}}) {
    std::vector<std::string> arguments = form;
    arguments.push_back("-");
    const Ended ended = Fit(arguments);
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("open curve of degree 3, 5 control points")) << form[0];
  }
}

TEST(Flags, EndAtTwoDashes) {
  const TemporaryFolder folder;
  ExpectRefused(Fit({"--control_points=5", "--", "--closed"}), {"--closed", "cannot be read"});
}

TEST(Flags, RefuseCombinationsThatMeanNothing) {
  ExpectRefused(Fit({"-", "--closed", "--control_points=5", "--ends=floating"}), {"--ends"});
  ExpectRefused(Fit({"-", "--control_points=5", "--domain=0,2"}), {"--domain", "parameters"});
  ExpectRefused(Fit({"-", "--parameters=given", "--control_points=5", "--domain=2,1"}),
                {"--domain: found \"2,1\"", "A < B"});
  ExpectRefused(Fit({"-", "--knots=0,1,oops"}), {"--knots: found \"0,1,oops\""});
  ExpectRefused(Fit({"-", "--knots=0,0,0,0,1,1,1,1", "--control_points=7"}),
                {"--control_points: found 7", "4, as the given knots make"});
  ExpectRefused(RunBatten({"compare", "--resume"}), {"--resume", "--out"});
}

TEST(Names, OfSolversProblemsTermsAndCommandsAreAnsweredWithTheNearest) {
  ExpectRefused(Fit({"-", "--control_points=5", "--solver=lbgfs"}),
                {"--solver: ", "unknown solver \"lbgfs\"", "did you mean lbfgs?"});
  ExpectRefused(Fit({"-", "--control_points=5", "--solver=LBFGS"}), {"did you mean lbfgs?"});
  ExpectRefused(Fit({"-", "--control_points=5", "--solver=lbfgs/memry=5"}),
                {"--solver: ", "memry", "did you mean memory"});
  ExpectRefused(Fit({"-", "--control_points=5", "--solver=lbfgs/memory=99"}), {"3 to 20"});
  ExpectRefused(Fit({"-", "--control_points=5", "--solver=lbfgs,cg"}), {"one solver"});
  ExpectRefused(Fit({"-", "--control_points=5", "--terms=interpolatoin"}),
                {"--terms: ", "did you mean interpolation?"});
  ExpectRefused(Fit({"--problem=rino"}), {"--problem: ", "unknown problem", "did you mean rhino?"});
  ExpectRefused(RunBatten({"compare", "--problems=rhino,squirel"}), {"did you mean squirrel?"});
  ExpectRefused(RunBatten({"compare", "--solvers=lbfgs,,cg"}), {"--solvers: "});
  ExpectRefused(RunBatten({"compare", "--problems=rhino,rhino"}), {"twice"});
  ExpectRefused(RunBatten({"fitt"}), {"unknown command \"fitt\"", "did you mean fit?"});
  ExpectRefused(RunBatten({"--degree=3", "fit"}), {"before the command"});
  ExpectRefused(RunBatten({}), {"no command", "fit, compare, report, list, help"});
}

TEST(Lists, TakeAllAmongOtherNames) {
  const Ended solvers = RunBatten({"compare", "--problems=rhino", "--repetitions=1",
                                   "--max_iterations=1", "--solvers=lbfgs/memory=5,all"});
  EXPECT_EQ(solvers.status, 0) << solvers.err;
  for (const char* name : {"lbfgs/memory=5", "banded_qr", "lspia", "lbfgs "}) {
    EXPECT_THAT(solvers.out, HasSubstr(name));
  }
  ExpectRefused(RunBatten({"compare", "--solvers=cg,all"}), {"--solvers: found \"cg twice\""});
  ExpectRefused(RunBatten({"compare", "--problems=rhino,all"}), {"\"rhino twice\""});
  ExpectRefused(Fit({"-", "--control_points=5", "--solver=all"}), {"one solver"});
}

TEST(Catalogue, ThatHoldsNothingIsNamed) {
  const TemporaryFolder folder;
  setenv("BATTEN_CATALOGUE", (folder / "none").c_str(), 1);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"compare", "--problems=all"}, {"list", "problems"}, {"list"}}) {
    ExpectRefused(RunBatten(arguments), {folder / "none", "No such file", "BATTEN_CATALOGUE"});
  }
  setenv("BATTEN_CATALOGUE", (folder / "").c_str(), 1);
  ExpectRefused(RunBatten({"list", "problems"}), {folder / "", "found no problem files"});
  EXPECT_EQ(RunBatten({"list", "solvers"}).status, 0);
  unsetenv("BATTEN_CATALOGUE");
}

TEST(Help, ShowsOnlyTheFlagsOfItsCommandWithUnitsAndDefaults) {
  const Ended fit = RunBatten({"help", "fit"});
  EXPECT_EQ(fit.status, 0);
  EXPECT_EQ(fit.err, "");
  for (const char* text : {"--degree=P", "[1 to 9; default: 3]", "seconds", "default: 1e-10",
                           "--[no]compile", "unit of length"}) {
    EXPECT_THAT(fit.out, HasSubstr(text));
  }
  for (const char* other : {"--repetitions", "--minloglevel", "--flagfile", "--json"}) {
    EXPECT_THAT(fit.out, Not(HasSubstr(other)));
  }
  EXPECT_THAT(RunBatten({"help", "compare"}).out, Not(HasSubstr("--degree")));
}

TEST(Help, StandsAnywhereAndComesFirst) {
  const std::string help = RunBatten({"help", "fit"}).out;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"fit", "--help"},
                                                    {"fit", "x.csv", "--degree=99", "--help"},
                                                    {"fit", "-help"},
                                                    {"fit", "-h"}}) {
    const Ended ended = RunBatten(arguments);
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.out, help);
    EXPECT_EQ(ended.err, "");
  }
  EXPECT_EQ(RunBatten({"--help"}).out, RunBatten({"help"}).out);
  ExpectRefused(RunBatten({"help", "fitt"}), {"did you mean fit?"});
}

TEST(Help, LinesFitInto100Columns) {
  for (const std::string command : {"fit", "compare", "list", "help"}) {
    for (const std::string& line : Lines(RunBatten({"help", command}).out)) {
      EXPECT_LE(line.size(), 100u) << line;
    }
  }
}

TEST(Version, NamesTheBuild) {
  const Ended ended = RunBatten({"--version"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.out, ::testing::StartsWith("batten 0."));
  EXPECT_EQ(RunBatten({"fit", "--version"}).out, ended.out);
}

TEST(List, IsReadByProgramsAndByPeople) {
  const nlohmann::json all = RunBatten({"list", "--json"}).Json();
  for (const char* kind : {"solvers", "terms", "problems"}) {
    ASSERT_FALSE(all[kind].empty()) << kind;
    const Ended text = RunBatten({"list", kind});
    EXPECT_EQ(text.status, 0);
    for (const auto& entry : all[kind]) {
      EXPECT_THAT(text.out, HasSubstr(entry["name"].get<std::string>()));
      EXPECT_FALSE(entry["summary"].get<std::string>().empty());
    }
    EXPECT_EQ(RunBatten({"list", kind, "--json"}).Json().size(), 1u);
  }
  ExpectRefused(RunBatten({"list", "solver"}), {"did you mean solvers?"});
  ExpectRefused(RunBatten({"list", "solvers", "terms"}), {"found 2 words"});
}

}  // namespace
}  // namespace batten
