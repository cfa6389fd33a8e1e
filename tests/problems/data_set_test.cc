#include "problems/data_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>
#include <sstream>

#include "cost_functions/options.h"

namespace batten {
namespace {

std::optional<DataSet> Read(const std::string& text) {
  std::istringstream stream(text);
  std::string error;
  std::optional<DataSet> data = ReadDataSet(stream, "p.csv", &error);
  EXPECT_TRUE(data.has_value()) << error;
  EXPECT_EQ(error, "");
  return data;
}

std::string Error(const std::string& text) {
  std::istringstream stream(text);
  std::string error;
  EXPECT_FALSE(ReadDataSet(stream, "p.csv", &error).has_value()) << text;
  return error;
}

std::string TestFile(const std::string& name, const std::string& contents) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << contents;
  return path;
}

const char kNumberRange[] = "a number from -1e150 to 1e150";
const char kAllColumns[] =
    "a header of x, y, z, w in this order, t, weight, separated by commas, "
    "or rows of numbers without commas";

TEST(ReadDataSet, ReadsCsvWithAHeader) {
  const auto data = Read("x,y\n1,2\n-3.5,4e2\n");
  ASSERT_TRUE(data.has_value());
  Points expected(2, 2);
  expected << 1, 2, -3.5, 400;
  EXPECT_EQ(data->points, expected);
  EXPECT_EQ(data->name, "p");
  EXPECT_FALSE(data->parameters.has_value());
  EXPECT_FALSE(data->weights.has_value());
}

TEST(ReadDataSet, FindsParametersAndWeightsInAnyColumn) {
  const auto data = Read("weight,x,t,y,z\n0,1,0.1,2,3\n2,4,-0.5,5,6\n");
  ASSERT_TRUE(data.has_value());
  Points expected(2, 3);
  expected << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(data->points, expected);
  EXPECT_EQ(data->parameters.value(), Eigen::Vector2d(0.1, -0.5));
  EXPECT_EQ(data->weights.value(), Eigen::Vector2d(0.0, 2.0));
}

TEST(ReadDataSet, ReadsRowsOfNumbersWithoutAHeader) {
  const auto data = Read("1 2\t3\n\t 4   5 6 \n+.5 -0 1e-3");
  ASSERT_TRUE(data.has_value());
  Points expected(3, 3);
  expected << 1, 2, 3, 4, 5, 6, 0.5, 0, 1e-3;
  EXPECT_EQ(data->points, expected);
}

TEST(ReadDataSet, ReadsOneToFourDimensions) {
  EXPECT_EQ(Read("x\n1\n2\n")->points.cols(), 1);
  EXPECT_EQ(Read("7\n8\n")->points.rows(), 2);
  EXPECT_EQ(Read("1 2 3 4\n")->points.cols(), 4);
  EXPECT_EQ(Read("x,y,z,w,t\n1,2,3,4,5\n")->points.cols(), 4);
  EXPECT_EQ(Error("1 2 3 4 5\n"), "p.csv:1:5: found 5 columns; allowed: 1 to 4");
}

TEST(ReadDataSet, SkipsCommentsEmptyLinesCarriageReturnsAndAByteOrderMark) {
  const auto data =
      Read("\xEF\xBB\xBF# made, by hand\r\n\r\n x , y\r\n#\r\n1 ,\t2\r\n   \r\n3,4\r\n\r\n");
  ASSERT_TRUE(data.has_value());
  Points expected(2, 2);
  expected << 1, 2, 3, 4;
  EXPECT_EQ(data->points, expected);
}

TEST(ReadDataSet, RefusesUnknownRepeatedMisplacedAndMissingColumns) {
  const std::string all = kAllColumns;
  EXPECT_EQ(Error("a,y\n1,2\n"), "p.csv:1:1: found \"a\" as a column name; allowed: " + all);
  EXPECT_EQ(Error("# c\nt,x,t\n"),
            "p.csv:2:3: found \"t\" as a column name; allowed: a header of x, y, z, w in this "
            "order, weight, separated by commas");
  EXPECT_EQ(Error("t,weight\n1,1\n"),
            "p.csv:1:3: found no coordinate column; allowed: a header of x, y, z, w in this order, "
            "separated by commas");
  for (const char* header : {"y,x", "x,z", "x,x", "X,Y", "x,,y", "x,y,", "x;y", "x y", "\"x\",y"}) {
    EXPECT_NE(Error(std::string(header) + "\n1,2\n").find("as a column name"), std::string::npos);
  }
}

TEST(ReadDataSet, RefusesCsvWithoutAHeader) {
  EXPECT_EQ(Error("1,2\n3,4\n"),
            std::string("p.csv:1:1: found \"1\" as a column name; allowed: ") + kAllColumns);
}

TEST(ReadDataSet, RefusesTextInANumber) {
  const std::string allowed = std::string("; allowed: ") + kNumberRange;
  EXPECT_EQ(Error("x,y\n1,2\n\n3,4m\n"), "p.csv:4:2: found \"4m\"" + allowed);
  EXPECT_EQ(Error("x,y\n,2\n"), "p.csv:2:1: found \"\"" + allowed);
}

TEST(ReadDataSet, RefusesNumbersThatAreNotFiniteOrTooLarge) {
  for (const char* text : {"nan", "NaN", "-nan", "inf", "-Infinity", "1e400", "-1e400", "1e151",
                           "-1.0001e150", "1e99999", "0x10", "1.0D5", "+-1", "1e", "--1", "-"}) {
    const std::string expected = std::string("found \"") + text + "\"; allowed: " + kNumberRange;
    EXPECT_EQ(Error(std::string("1 2\n3 ") + text + "\n"), "p.csv:2:2: " + expected);
    EXPECT_EQ(Error(std::string("t,x\n") + text + ",1\n"), "p.csv:2:1: " + expected);
  }
  EXPECT_EQ(Error("nan 1\n"), std::string("p.csv:1:1: found \"nan\"; allowed: ") + kNumberRange);
}

TEST(ReadDataSet, TakesTheLargestAndTheSmallestNumbers) {
  const auto data = Read("1e150 -1e150\n4.9e-324 1e-400\n");
  ASSERT_TRUE(data.has_value());
  EXPECT_EQ(data->points(0, 0), 1e150);
  EXPECT_EQ(data->points(0, 1), -1e150);
  EXPECT_EQ(data->points(1, 0), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(data->points(1, 1), 0.0);
}

TEST(ReadDataSet, RefusesRowsOfDifferentLength) {
  EXPECT_EQ(Error("# c\nx,y\n1,2\n3\n"), "p.csv:4:2: found row length 1; allowed: 2 as in line 2");
  EXPECT_EQ(Error("x,y\n1,2,\n"), "p.csv:2:3: found row length 3; allowed: 2 as in line 1");
  EXPECT_EQ(Error("1 2\n3 4 # end\n"), "p.csv:2:3: found row length 4; allowed: 2 as in line 1");
}

TEST(ReadDataSet, RefusesNegativeWeightsAndWeightsThatAreAllZero) {
  EXPECT_EQ(Error("x,weight\n1,-1e-9\n"),
            "p.csv:2:2: found \"-1e-9\"; allowed: a weight from 0 to 1e150");
  EXPECT_EQ(Error("\nx,weight\n1,0\n2,0\n"),
            "p.csv:2:2: found only zeros in column weight; allowed: at least one weight above 0");
}

TEST(ReadDataSet, RefusesAFileWithoutPoints) {
  EXPECT_EQ(Error(""), "p.csv:1:1: found no data point up to the end; allowed: at least one");
  EXPECT_EQ(Error("# a\n\n"),
            "p.csv:2:1: found no data point up to the end; allowed: at least one");
  EXPECT_EQ(Error("x,y\n"), "p.csv:1:1: found no data point up to the end; allowed: at least one");
}

TEST(ReadDataSet, ShowsStrangeBytesAsOneLineOfAscii) {
  for (const std::string& text :
       {std::string("\xFF\xFE"
                    "1\0 \0"
                    "2\0",
                    8),
        std::string("\0\0\0", 3), std::string("1 2\r3 4\n"), std::string("1 \xC3\xA9\n"),
        std::string("x,y\n1,") + std::string(100000, '\x01')}) {
    const std::string error = Error(text);
    EXPECT_EQ(error.rfind("p.csv:", 0), 0u) << error;
    EXPECT_LT(error.size(), 400u);
    for (const char c : error) EXPECT_TRUE(c >= 32 && c < 127) << error;
  }
}

TEST(ReadDataSet, GivesUpAnEndlessLine) {
  EXPECT_EQ(Error("1 2\n" + std::string(5000000, '1')),
            "p.csv:2:1: found a line of more than 1048576 bytes; allowed: shorter lines");
}

TEST(ReadDataSet, ReadsAcrossItsChunksTheSameBits) {
  std::mt19937 random(20240612);
  std::normal_distribution<double> normal;
  Points expected(100000, 2);
  std::string text = "x,y,t\n";
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    expected.row(i) << normal(random), normal(random) * 1e-7;
    text += NumberText(expected(i, 0)) + "," + NumberText(expected(i, 1)) + "," +
            std::to_string(i) + "\n";
    if (i % 1000 == 0) text += "#" + std::string(static_cast<size_t>(i), 'c') + "\n";
  }
  ASSERT_GT(text.size(), size_t{4} << 20);
  const auto data = Read(text);
  ASSERT_TRUE(data.has_value());
  EXPECT_EQ(data->points, expected);
  EXPECT_EQ(data->parameters->size(), expected.rows());
  EXPECT_EQ((*data->parameters)[99999], 99999.0);
  EXPECT_EQ(Error(text + "1,2\n").rfind("p.csv:100102:3: ", 0), 0u);
}

TEST(ReadDataSet, NamesTheDataAfterTheFile) {
  std::string error;
  const auto data = ReadDataSet(TestFile("rhino.v2.csv", "x,y\n1,2\n"), &error);
  ASSERT_TRUE(data.has_value()) << error;
  EXPECT_EQ(data->name, "rhino.v2");
  const std::string path = TestFile("bad.csv", "x,y\n1,a\n");
  EXPECT_FALSE(ReadDataSet(path, &error).has_value());
  EXPECT_EQ(error, path + ":2:2: found \"a\"; allowed: " + kNumberRange);
}

TEST(ReadDataSet, SaysWhyAFileCannotBeRead) {
  std::string error;
  EXPECT_FALSE(ReadDataSet("no/such/file.csv", &error).has_value());
  EXPECT_EQ(error, "no/such/file.csv: cannot be read: No such file or directory");
  EXPECT_FALSE(ReadDataSet(testing::TempDir(), &error).has_value());
  EXPECT_EQ(error, testing::TempDir() + ": cannot be read: Is a directory");
  EXPECT_FALSE(ReadDataSet("", &error).has_value());
  EXPECT_EQ(error, ": cannot be read: No such file or directory");
}

class FailingBuffer : public std::streambuf {
 protected:
  std::streamsize xsgetn(char* to, std::streamsize size) override {
    if (has_been_read_) throw std::ios_base::failure("the disk is gone");
    has_been_read_ = true;
    std::fill_n(to, size, '\n');
    std::copy_n("1 2\n", 4, to);
    return size;
  }

 private:
  bool has_been_read_ = false;
};

TEST(ReadDataSet, DoesNotTakeAReadErrorForTheEnd) {
  FailingBuffer buffer;
  std::istream stream(&buffer);
  std::string error;
  EXPECT_FALSE(ReadDataSet(stream, "p.csv", &error).has_value());
  EXPECT_EQ(error, "p.csv: cannot be read: Input/output error");
}

TEST(ReadDataSet, ReadsStandardInput) {
  std::istringstream input("1 2\n3 4\n");
  std::streambuf* const before = std::cin.rdbuf(input.rdbuf());
  std::string error;
  const auto data = ReadDataSet("-", &error);
  std::cin.rdbuf(before);
  ASSERT_TRUE(data.has_value()) << error;
  EXPECT_EQ(data->points.rows(), 2);
  EXPECT_EQ(data->name, "stdin");
}

}  // namespace
}  // namespace batten
