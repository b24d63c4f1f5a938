#include "program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "orchard/geometry/mesh_io.h"

namespace orchard::test {
namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string in_quotes(const std::string& argument) {
  std::string text(1, '\'');
  for (const char c : argument) {
    if (c == '\'') {
      text += "'\\''";
    } else {
      text += c;
    }
  }
  text += '\'';
  return text;
}

}  // namespace

Workplace::Workplace() {
  std::string name = (std::filesystem::temp_directory_path() / "orchard-apps-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = name;
}

Workplace::~Workplace() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string Workplace::add(const std::string& name, const TriangleMesh& mesh) const {
  write_obj(folder_ / name, mesh);
  return (folder_ / name).string();
}

std::string Workplace::add(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
  return (folder_ / name).string();
}

Finished Workplace::run(const std::vector<std::string>& arguments, const std::string& out_to) const {
  std::string command = in_quotes(ORCHARD_PROGRAM);
  for (const std::string& argument : arguments) (command += ' ') += in_quotes(argument);
  const std::string out = (folder_ / "stdout").string(), err = (folder_ / "stderr").string();
  command.append(" >").append(out_to.empty() ? in_quotes(out) : out_to).append(" 2>").append(in_quotes(err));
  const int status = std::system(command.c_str());
  Finished finished{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return finished;
}

std::map<std::string, std::string> Workplace::files(const std::string& folder) const {
  std::map<std::string, std::string> files;
  if (!std::filesystem::exists(folder_ / folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / folder)) {
    if (entry.is_regular_file()) files[entry.path().filename().string()] = read(entry.path());
  }
  return files;
}

namespace {

constexpr std::chrono::seconds kPatience{30};
constexpr std::chrono::milliseconds kPoll{2};

template <class Condition>
bool wait_for(const Condition& condition) {
  for (const auto end = std::chrono::steady_clock::now() + kPatience; std::chrono::steady_clock::now() < end;) {
    if (condition()) return true;
    std::this_thread::sleep_for(kPoll);
  }
  return condition();
}

}  // namespace

Running::Running(const std::vector<std::string>& arguments, const std::vector<std::string>& variables,
                 const std::filesystem::path& err) {
  std::vector<std::string> words{ORCHARD_PROGRAM}, all = variables;
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable, name = text.substr(0, text.find('=') + 1);
    if (std::none_of(variables.begin(), variables.end(), [&](const std::string& v) { return v.starts_with(name); }))
      all.push_back(text);
  }
  std::vector<char*> argv, envp;
  for (std::string& word : words) argv.push_back(word.data());
  for (std::string& variable : all) envp.push_back(variable.data());
  argv.push_back(nullptr);
  envp.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Signals that the test's own parent ignores would stay ignored.
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&defaults, number);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  const int failure = posix_spawn(&pid_, ORCHARD_PROGRAM, &actions, &attributes, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failure != 0) throw std::runtime_error("the program cannot be started");
}

Running::~Running() {
  kill(-pid_, SIGKILL);
  if (!status_) waitpid(pid_, nullptr, 0);
}

void Running::send(int signal) const { kill(pid_, signal); }
void Running::send_to_group(int signal) const { kill(-pid_, signal); }

bool Running::ended() {
  int status = 0;
  if (!status_ && waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
  return status_.has_value();
}

bool Running::listens() const {
  return wait_for([&] {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("SigCgt:")) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
    return false;
  });
}

int Running::wait() {
  if (!wait_for([&] { return ended(); }) || !WIFEXITED(*status_)) return -1;
  return WEXITSTATUS(*status_);
}

bool appears(const std::filesystem::path& file) {
  return wait_for([&] { return std::filesystem::exists(file); });
}

std::vector<std::string> quick_build(const std::string& mesh, const std::string& folder,
                                     const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"build", mesh, "-o", folder, "--method", "octree", "--depth", "2", "--no-views"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string without_provenance(const std::string& text) {
  const std::size_t line = text.find("\n# orchard {");
  if (line == std::string::npos || text.find('\n', line + 1) + 1 != text.size())
    throw std::runtime_error("the last line does not say where the file comes from");
  return text.substr(0, line + 1);
}

bool is_one_line_error(const std::string& err) {
  return err.starts_with("orchard: ") && err.ends_with('\n') && std::count(err.begin(), err.end(), '\n') == 1;
}

}  // namespace orchard::test
