#ifndef BATTEN_PROBLEMS_DATA_FOLDERS_H_
#define BATTEN_PROBLEMS_DATA_FOLDERS_H_

#include <string>
#include <vector>

namespace batten {

/// The folder that holds data/ and problems/catalogue/: that of the installation which the running
/// program is part of, else the source tree where it still stands, else where the installation was
/// to go when Batten was built.
std::string DataRoot();

/// BATTEN_CATALOGUE if it is set and not empty, else problems/catalogue of DataRoot().
std::string CatalogueFolder();

/// Folders in which a data file named in `problem_file` is looked for, in this order: the problem
/// file's own, the data folder of the tree whose problems/catalogue it stands in, and DataRoot()'s.
std::vector<std::string> DataFolders(const std::string& problem_file);

/// `name` if it is absolute, else its path in the first of DataFolders() that has such a file.
/// Empty if there is none.
std::string FindDataFile(const std::string& name, const std::string& problem_file);

/// What a data file named in `problem_file` can be, for the message that refuses `name`: "a file in
/// FOLDER or FOLDER", and the one that may be meant.
std::string AllowedDataFiles(const std::string& name, const std::string& problem_file);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_DATA_FOLDERS_H_
