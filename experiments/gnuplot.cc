#include "experiments/gnuplot.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

#include "cost_functions/options.h"
#include "experiments/atomic_file.h"

namespace batten {
namespace {

constexpr int kNotFound = 127;

std::string Folder(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

/// Begins with "./": a name of its own may begin with a character that means something to gnuplot,
/// as "<" and "|" do.
std::string LocalName(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return "./" + (slash == std::string::npos ? path : path.substr(slash + 1));
}

/// In the child: gnuplot in `folder`, without a shell that would read the name.
[[noreturn]] void RunScript(const std::string& folder, const std::string& script, int output,
                            int errors) {
  const int nothing = open("/dev/null", O_RDONLY);
  const bool ready = nothing >= 0 && dup2(nothing, 0) == 0 && dup2(output, 1) == 1 &&
                     dup2(errors, 2) == 2 && chdir(folder.c_str()) == 0;
  // The picture comes back through the pipe, so that the file is written whole or not at all.
  if (ready) {
    execlp("gnuplot", "gnuplot", "-e", "to_standard_output = 1", script.c_str(),
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

/// What gnuplot draws, or a sentence in `error`.
bool Draw(const std::string& folder, const std::string& script, std::string* picture,
          std::string* error) {
  int ends[2];
  std::FILE* errors = std::tmpfile();
  if (errors == nullptr || pipe2(ends, O_CLOEXEC) != 0) {
    *error = std::string("cannot start gnuplot: ") + std::strerror(errno);
    if (errors != nullptr) std::fclose(errors);
    return false;
  }
  const pid_t child = fork();
  if (child == 0) RunScript(folder, script, ends[1], fileno(errors));
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
  return "# Draws the picture again: gnuplot " + name.substr(2) +
         ".gp, in this folder.\n"
         "DATA = " +
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

}  // namespace

FigureResult DrawFigure(const std::string& stem, const std::string& data,
                        const std::string& commands, int width, int height) {
  FigureResult result;
  const std::string script = Header(stem, width, height) + commands;
  result.written = WriteFileAtomically(stem + ".dat", data, &result.message) &&
                   WriteFileAtomically(stem + ".gp", script, &result.message);
  if (!result.written) return result;
  std::string picture;
  if (!Draw(Folder(stem), LocalName(stem) + ".gp", &picture, &result.message)) {
    result.message += "; " + stem + ".gp and its data are there to draw " + stem + ".svg with";
    return result;
  }
  result.drawn = WriteFileAtomically(stem + ".svg", picture, &result.message);
  return result;
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

}  // namespace batten
