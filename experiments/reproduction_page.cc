#include "experiments/reproduction_page.h"

#include <md4c-html.h>

#include <cmath>
#include <filesystem>

#include "cost_functions/options.h"
#include "experiments/atomic_file.h"
#include "experiments/build_info.h"
#include "experiments/short_number.h"
#include "problems/input_file.h"

namespace batten {
namespace {

/// As the text of a table's cell.
std::string Cell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

/// Numbers with many digits are shown short; the CSV has them all.
std::string Shown(const std::string& cell) {
  double value = 0.0;
  if (cell.empty() || cell == "nan") return "-";
  if (!ParseNumber(cell, &value)) return Cell(cell);
  const bool whole = value == std::floor(value) && std::abs(value) < 1e8;
  return whole ? cell : ShortNumber(value, 4);
}

std::string TableText(const CsvTable& table) {
  std::string text = "|";
  for (const std::string& column : table.columns()) text += " " + Cell(column) + " |";
  text += "\n|";
  for (std::size_t k = 0; k < table.columns().size(); ++k) text += "---|";
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    text += "\n|";
    for (const std::string& column : table.columns()) {
      text += " " + Shown(table.Text(row, column)) + " |";
    }
  }
  return text + "\n\n";
}

std::string ClaimText(const SourceClaim& claim, const Judgement& judgement) {
  return "> " + claim.quote + " (" + claim.place + ")\n\n**" + ToString(judgement.verdict) +
         "**: " + judgement.because + "  \nRule: " + claim.rule + "\n\n";
}

std::string Summary(const std::vector<ExperimentResult>& results) {
  std::string text = "| experiment | claim | verdict |\n|---|---|---|\n";
  for (const ExperimentResult& result : results) {
    for (std::size_t k = 0; k < result.judgements.size(); ++k) {
      text += "| " + Cell(result.experiment->title) + " | " +
              Cell(result.experiment->claims[k].quote) + " | " +
              ToString(result.judgements[k].verdict) + " |\n";
    }
  }
  return text + "\n";
}

std::string FileNames(const ExperimentResult& result) {
  std::string text = "Data: ";
  bool first = true;
  for (const auto& [name, table] : result.tables) {
    const std::string file = result.experiment->name + (name.empty() ? "" : "_" + name) + ".csv";
    text += (first ? "" : ", ") + std::string("[") + file + "](" + file + ")";
    first = false;
  }
  return text + ".\n\n";
}

/// As a data address: what has a meaning in addresses or in HTML is written as %NN.
std::string DataAddress(const std::string& svg) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string text = "data:image/svg+xml,";
  for (const char c : svg) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || byte < 0x20 ||
        std::string("%#<>\"'&{}|\\^`").find(c) != std::string::npos) {
      text += {'%', kHex[byte >> 4], kHex[byte & 15]};
    } else {
      text += c;
    }
  }
  return text;
}

std::string WithPicturesPutIn(const std::string& html, const std::string& folder) {
  const std::string mark = "<img src=\"";
  std::string text;
  std::size_t begin = 0;
  while (true) {
    const std::size_t found = html.find(mark, begin);
    if (found == std::string::npos) return text + html.substr(begin);
    const std::size_t name = found + mark.size();
    const std::size_t end = html.find('"', name);
    const std::string file = html.substr(name, end - name);
    const std::string path = (std::filesystem::path(folder) / file).string();
    std::string picture, error;
    const bool is_there = ReadWholeFile(path, &picture, &error);
    text += html.substr(begin, name - begin) + (is_there ? DataAddress(picture) : file);
    begin = end;
  }
}

void AppendTo(const MD_CHAR* text, MD_SIZE size, void* target) {
  static_cast<std::string*>(target)->append(text, size);
}

constexpr char kStyle[] =
    "body{font:16px/1.5 sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}"
    "table{border-collapse:collapse;font-size:.85rem;display:block;overflow-x:auto}"
    "td,th{border-bottom:1px solid #ddd;padding:.2rem .6rem;text-align:right}"
    "td:first-child,th:first-child{text-align:left}"
    "blockquote{border-left:3px solid #0072b2;margin-left:0;padding-left:1rem;color:#444}"
    "img{max-width:100%}";

}  // namespace

std::string ReproductionMarkdown(const Reproduction& reproduction,
                                 const std::vector<ExperimentResult>& results) {
  std::string text = "# " + reproduction.title + "\n\nSource: " + reproduction.source + "\n\n" +
                     reproduction.introduction + "\n\nMade by batten " + kVersion + " (" +
                     kGitCommit + ").\n\n## Verdicts\n\n" + Summary(results);
  for (const ExperimentResult& result : results) {
    const Experiment& experiment = *result.experiment;
    text += "## " + experiment.title + "\n\n" + experiment.text + "\n\n";
    for (std::size_t k = 0; k < experiment.claims.size(); ++k) {
      text += ClaimText(experiment.claims[k], result.judgements[k]);
    }
    for (std::size_t k = 0; k < experiment.figures.size(); ++k) {
      const ExperimentFigure& figure = experiment.figures[k];
      if (result.not_drawn[k].empty()) {
        text += "![" + figure.name + "](" + figure.name + ".svg)\n\n";
      } else {
        text += "(No picture: " + result.not_drawn[k] + ")\n\n";
      }
      text += "*" + figure.caption + "*\n\n";
    }
    text += TableText(experiment.shown ? experiment.shown(result.tables) : result.tables.at(""));
    text += FileNames(result);
  }
  return text;
}

std::string SelfContainedHtml(const std::string& title, const std::string& markdown,
                              const std::string& folder) {
  std::string body;
  md_html(markdown.data(), static_cast<MD_SIZE>(markdown.size()), &AppendTo, &body, MD_FLAG_TABLES,
          0);
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title +
         "</title><style>" + kStyle + "</style></head><body>\n" + WithPicturesPutIn(body, folder) +
         "</body></html>\n";
}

bool WritePage(const Reproduction& reproduction, const std::vector<ExperimentResult>& results,
               const std::string& folder, std::string* error) {
  const std::string markdown = ReproductionMarkdown(reproduction, results);
  const std::string stem = (std::filesystem::path(folder) / reproduction.name).string();
  FileBatch batch;
  return batch.Write(stem + ".md", markdown, error) != nullptr &&
         batch.Write(stem + ".html", SelfContainedHtml(reproduction.title, markdown, folder),
                     error) != nullptr &&
         batch.Commit(error);
}

}  // namespace batten
