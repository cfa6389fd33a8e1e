#include "tools/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace batten {
namespace {

// Short enough for a bar that moves, long enough for a log that can be read.
constexpr auto kBarInterval = std::chrono::milliseconds(100);
constexpr auto kLineInterval = std::chrono::seconds(5);

size_t TerminalColumns() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

void WriteToError(const std::string& text) {
  // Progress that cannot be shown is no reason to stop.
  const ssize_t ignored = write(STDERR_FILENO, text.data(), text.size());
  static_cast<void>(ignored);
}

}  // namespace

Progress::Progress(bool quiet) {
  const char* const terminal = std::getenv("TERM");
  const bool can_erase = terminal != nullptr && std::strcmp(terminal, "dumb") != 0;
  if (!quiet) style_ = isatty(STDERR_FILENO) == 1 && can_erase ? Style::kBar : Style::kLines;
  interval_ =
      style_ == Style::kBar ? Clock::duration(kBarInterval) : Clock::duration(kLineInterval);
  next_ = Clock::now() + interval_;
}

Progress::~Progress() {
  if (bar_is_shown_) WriteToError("\r\033[K");
}

bool Progress::IsDue() const { return style_ != Style::kSilent && Clock::now() >= next_; }

void Progress::Show(double fraction, const std::string& text) {
  if (!IsDue()) return;
  next_ = Clock::now() + interval_;
  fraction = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const auto percent = static_cast<int>(100.0 * fraction);
  if (style_ == Style::kLines) {
    WriteToError(std::to_string(percent) + "%  " + text + "\n");
    return;
  }
  constexpr size_t kWidth = 24;
  const auto filled = static_cast<size_t>(kWidth * fraction);
  std::string line = "[" + std::string(filled, '#') + std::string(kWidth - filled, ' ') + "] " +
                     std::to_string(percent) + "%  " + text;
  // A line that wraps could not be erased; the last column may wrap too.
  line.resize(std::min(line.size(), TerminalColumns() - 1));
  WriteToError("\r\033[K" + line);
  bar_is_shown_ = true;
}

}  // namespace batten
