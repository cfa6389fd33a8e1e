#ifndef BATTEN_EXPERIMENTS_GNUPLOT_H_
#define BATTEN_EXPERIMENTS_GNUPLOT_H_

#include <string>
#include <vector>

#include "experiments/atomic_file.h"

namespace batten {

/// A figure is NAME.dat, NAME.gp and NAME.svg. The script names the others relative to its folder:
/// `gnuplot NAME.gp` there draws the picture again, after any change of style.
struct FigureResult {
  bool written = false;  // data and script, into the batch
  bool drawn = false;    // the picture too
  std::string message;   // one sentence where something is missing, and why
};

/// Adds STEM.dat and STEM.gp to `batch`, and STEM.svg as the gnuplot on PATH draws it. A picture
/// that cannot be drawn is missing after the batch's Commit(), be there an older one or not; where
/// a file cannot be written the message begins with "cannot write", and the batch is not to be
/// committed. `commands` is the script after its terminal and output are set; `DATA` in it is the
/// name of the data file as a gnuplot string.
FigureResult DrawFigure(const std::string& stem, const std::string& data,
                        const std::string& commands, int width, int height, FileBatch* batch);

/// The disk's fault and not that of gnuplot, without which the script and data still serve.
bool IsWriteError(const FigureResult& figure);

/// Where there is nothing to draw: an older figure, which would show something else, goes.
FigureResult NoFigure(const std::string& stem, const std::string& why, FileBatch* batch);

/// `text` as a string of gnuplot in which nothing is substituted.
std::string GnuplotString(const std::string& text);

/// `text`, which may be any bytes, as it can be shown: what is no character of XML becomes U+FFFD,
/// and of more than `most` characters the middle is left out.
std::string ShownText(const std::string& text, std::size_t most);

/// Numbers of a data file, separated by spaces; what is no finite number is `?`.
std::string GnuplotNumbers(const std::vector<double>& values);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_GNUPLOT_H_
