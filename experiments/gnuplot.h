#ifndef BATTEN_EXPERIMENTS_GNUPLOT_H_
#define BATTEN_EXPERIMENTS_GNUPLOT_H_

#include <string>
#include <vector>

namespace batten {

/// A figure is NAME.dat, NAME.gp and NAME.svg. The script names the others relative to its folder:
/// `gnuplot NAME.gp` there draws the picture again, after any change of style.
struct FigureResult {
  bool written = false;  // data and script
  bool drawn = false;    // the picture too
  std::string message;   // one sentence where something is missing, and why
};

/// Writes STEM.dat and STEM.gp, each whole or not at all, and draws STEM.svg with the gnuplot on
/// PATH. `commands` is the script after its terminal and output are set; `DATA` in it is the name
/// of the data file as a gnuplot string.
FigureResult DrawFigure(const std::string& stem, const std::string& data,
                        const std::string& commands, int width, int height);

/// `text` as a string of gnuplot in which nothing is substituted.
std::string GnuplotString(const std::string& text);

/// Numbers of a data file, separated by spaces; what is no finite number is `?`.
std::string GnuplotNumbers(const std::vector<double>& values);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_GNUPLOT_H_
