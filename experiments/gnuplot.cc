#include "experiments/gnuplot.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cost_functions/options.h"

namespace batten {
namespace {

constexpr int kNotFound = 127;

std::string AbsolutePath(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::absolute(path, ignored).string();
}

/// Begins with "./": a name of its own may begin with a character that means something to gnuplot,
/// as "<" and "|" do.
std::string LocalName(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return "./" + (slash == std::string::npos ? path : path.substr(slash + 1));
}

/// In the child: gnuplot without a shell that would read the names.
[[noreturn]] void RunScript(const std::string& script, const std::string& settings, pid_t parent,
                            int output, int errors) {
  // It ends with us, however we end; keys that interrupt us are ours to answer, not its.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDONLY);
  const bool ready = getppid() == parent && nothing >= 0 && dup2(nothing, 0) == 0 &&
                     dup2(output, 1) == 1 && dup2(errors, 2) == 2;
  if (ready) {
    execlp("gnuplot", "gnuplot", "-e", settings.c_str(), script.c_str(),
           static_cast<char*>(nullptr));
  }
  _exit(kNotFound);
}

std::string ReadAll(int descriptor) {
  std::string text;
  char buffer[1 << 16];
  while (true) {
    const ssize_t count = read(descriptor, buffer, sizeof(buffer));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(count));
  }
}

/// The line that says what is wrong, which names the script and its line, or else the last one.
std::string Complaint(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::string last = "it says nothing";
  while (std::getline(lines, line)) {
    if (line.find("\" line ") != std::string::npos) return line;
    if (line.find_first_not_of(" \r^") != std::string::npos) last = line;
  }
  return last;
}

/// What gnuplot draws, or a sentence in `error`. Script and data are read where they are now; the
/// picture comes back through a pipe, so that its file is written whole or not at all.
bool Draw(const AtomicFile& script, const AtomicFile& data, std::string* picture,
          std::string* error) {
  int ends[2];
  std::FILE* errors = std::tmpfile();
  if (errors == nullptr || pipe2(ends, O_CLOEXEC) != 0) {
    *error = std::string("cannot start gnuplot: ") + std::strerror(errno);
    if (errors != nullptr) std::fclose(errors);
    return false;
  }
  const std::string path = AbsolutePath(script.place());
  const std::string settings =
      "to_standard_output = 1; DATA = " + GnuplotString(AbsolutePath(data.place()));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) RunScript(path, settings, parent, ends[1], fileno(errors));
  close(ends[1]);
  int status = -1;
  if (child > 0) {
    *picture = ReadAll(ends[0]);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  close(ends[0]);
  lseek(fileno(errors), 0, SEEK_SET);
  const std::string complaint = ReadAll(fileno(errors));
  std::fclose(errors);
  if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0 && !picture->empty()) return true;
  const bool missing = child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == kNotFound;
  *error = missing ? "gnuplot is not on PATH (Debian: gnuplot-nox)"
                   : "gnuplot failed: " + Complaint(complaint);
  return false;
}

std::string Header(const std::string& stem, int width, int height) {
  const std::string name = LocalName(stem);
  return "# gnuplot draws the picture again from this script, in its folder.\n"
         "if (!exists('DATA')) DATA = " +
         GnuplotString(name + ".dat") +
         "\n"
         "set terminal svg size " +
         std::to_string(width) + "," + std::to_string(height) +
         " font 'Helvetica,Arial,sans-serif,14' background rgb 'white'\n"
         "if (!exists('to_standard_output')) set output " +
         GnuplotString(name + ".svg") +
         "\n"
         "set encoding utf8\n"
         "set datafile missing '?'\n";
}

void ReplaceAll(const std::string& from, const std::string& to, std::string* text) {
  for (std::size_t at = text->find(from); at != std::string::npos; at = text->find(from, at)) {
    text->replace(at, from.size(), to);
    at += to.size();
  }
}

/// Where the character that follows the one at `at` begins.
std::size_t NextCharacter(const std::string& text, std::size_t at) {
  do ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80);
  return at;
}

}  // namespace

FigureResult DrawFigure(const std::string& stem, const std::string& data,
                        const std::string& commands, int width, int height, FileBatch* batch) {
  FigureResult result;
  const AtomicFile* const data_file = batch->Write(stem + ".dat", data, &result.message);
  if (data_file == nullptr) return result;
  const AtomicFile* const script =
      batch->Write(stem + ".gp", Header(stem, width, height) + commands, &result.message);
  if (script == nullptr) return result;
  result.written = true;
  std::string picture;
  if (Draw(*script, *data_file, &picture, &result.message)) {
    result.drawn = batch->Write(stem + ".svg", picture, &result.message) != nullptr;
  } else {
    batch->Remove(stem + ".svg");
    ReplaceAll(AbsolutePath(script->place()), stem + ".gp", &result.message);
    result.message += "; " + stem + ".gp and its data are there to draw " + stem + ".svg with";
  }
  return result;
}

FigureResult NoFigure(const std::string& stem, const std::string& why, FileBatch* batch) {
  for (const char* ending : {".dat", ".gp", ".svg"}) batch->Remove(stem + ending);
  FigureResult result;
  result.message = why;
  return result;
}

std::string ShownText(const std::string& text, std::size_t most) {
  using Json = nlohmann::json;
  // The library's writer replaces what is no UTF-8, but leaves what UTF-8 may hold and XML may not.
  std::string shown = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
  const std::string replacement = "\xEF\xBF\xBD";
  for (const char* none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"}) ReplaceAll(none, replacement, &shown);
  std::vector<std::string> characters;
  for (std::size_t at = 0, next = 0; at < shown.size(); at = next) {
    next = NextCharacter(shown, at);
    const bool is_control = static_cast<unsigned char>(shown[at]) < 32 || shown[at] == 127;
    characters.push_back(is_control ? replacement : shown.substr(at, next - at));
  }
  const std::size_t head = characters.size() <= most ? characters.size() : most / 2;
  shown.clear();
  for (std::size_t k = 0; k < characters.size(); ++k) {
    if (k == head) shown += "\xE2\x80\xA6";  // an ellipsis
    if (k < head || k + (most - most / 2 - 1) >= characters.size()) shown += characters[k];
  }
  return shown;
}

std::string GnuplotString(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    // Single quotes: a quote is written twice, nothing else is special; a line cannot end inside.
    if (c == '\'') quoted += '\'';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "'";
}

std::string GnuplotNumbers(const std::vector<double>& values) {
  std::string line;
  for (const double value : values) {
    if (!line.empty()) line += ' ';
    line += std::isfinite(value) ? NumberText(value) : "?";
  }
  return line + "\n";
}

bool IsWriteError(const FigureResult& figure) {
  return !figure.drawn && figure.message.compare(0, 12, "cannot write") == 0;
}

}  // namespace batten
