#ifndef BATTEN_TOOLS_PROGRESS_H_
#define BATTEN_TOOLS_PROGRESS_H_

#include <chrono>
#include <string>

namespace batten {

/// Progress on standard error: a bar on a terminal, now and then a line elsewhere, nothing if
/// quiet. What is over quickly shows nothing. The bar is gone when this is.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The next Show() would show something: asked first where the text is costly.
  bool IsDue() const;
  /// `fraction` of the work is done, 0..1.
  void Show(double fraction, const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Style { kSilent, kBar, kLines };

  Style style_ = Style::kSilent;
  Clock::duration interval_{};
  Clock::time_point next_;
  bool bar_is_shown_ = false;
};

}  // namespace batten

#endif  // BATTEN_TOOLS_PROGRESS_H_
