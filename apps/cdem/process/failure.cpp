#include "apps/cdem/process/failure.hpp"

#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/terminal.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>

namespace cdem::app {

namespace {

Failure make_failure(ExitCode code, const std::string& message) {
  Failure failure;
  failure.code = code;
  const auto end = message.find('\n');
  failure.line = message.substr(0, end);
  if (end != std::string::npos)
    failure.details = message;
  return failure;
}

} // namespace

Failure current_failure() {
  try {
    throw;
  } catch (const Interrupted&) {
    const ExitCode code = interrupt::exit_code();
    return make_failure(code, code == ExitCode::terminated ? "stopped by SIGTERM" : "stopped by Ctrl-C");
  } catch (const SolutionError& error) {
    return make_failure(ExitCode::solution_failed, error.what());
  } catch (const script::FileError& error) {
    return make_failure(ExitCode::file_error, error.what());
  } catch (const script::ScriptError& error) {
    return make_failure(ExitCode::bad_input, error.what());
  } catch (const geom::InputError& error) {
    return make_failure(ExitCode::bad_input, error.what());
  } catch (const UsageError& error) {
    return make_failure(ExitCode::bad_input, error.what());
  } catch (const RankLost& error) {
    return make_failure(ExitCode::rank_lost, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return make_failure(ExitCode::file_error, error.path1().string() + ": " + error.code().message());
  } catch (const std::bad_alloc&) {
    return make_failure(ExitCode::bad_input, not_enough_memory);
  } catch (const std::length_error&) { // a list as long as no memory can hold
    return make_failure(ExitCode::bad_input, not_enough_memory);
  } catch (const std::exception& error) {
    return make_failure(ExitCode::internal_error,
                        std::string("internal error, please report it: ") + geom::plain_reason(error));
  } catch (...) {
    return make_failure(ExitCode::internal_error, "internal error, please report it: unknown exception");
  }
}

void print_failure(const Failure& failure) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", with_tone("cdem: error: " + failure.line, Tone::error).c_str());
}

} // namespace cdem::app
