#ifndef BATTEN_EXPERIMENTS_PLOT_FILE_H_
#define BATTEN_EXPERIMENTS_PLOT_FILE_H_

#include <string>
#include <vector>

#include "experiments/plot.h"

namespace batten {

/// The panels as they stand in STEM.plot.json (docs/formats.md): numbers with all their digits,
/// what is no finite number as null.
std::string PlotJson(const std::vector<PlotPanel>& panels, int columns);

/// DrawPlot(), and STEM.plot.json beside the picture, from which the report page draws a plot that
/// zooms and shows values. Of no panels, or where there is nothing to draw, older files go.
FigureResult DrawPlotForReport(const std::string& stem, const std::vector<PlotPanel>& panels,
                               int columns, FileBatch* batch);

/// The word for a style in the file: "line", "points", "line_points", "dashed", "circles",
/// "one_of_many".
const char* ToString(PlotSeries::Style style);
bool FromString(const std::string& text, PlotSeries::Style* style);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_PLOT_FILE_H_
