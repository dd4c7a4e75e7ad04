// Processes that solve one model together, on one machine or many. Each is a rank: it runs the same script on the same
// values, computes the forces of its own chunks, and learns the rest from the others. Rank 0 alone writes files and talks
// to the user. Sums are exact or added in the order of chunks, so results do not depend on how many there
// are; least and largest values are exact anyway.
//
// Every call of a rank here is met by the same call of all others, but for abort.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cdem {

class Ranks {
public:
  virtual ~Ranks() = default;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool alone() const { return size_ == 1; }
  bool leads() const { return rank_ == 0; } // it writes files and talks to the user

  // Bytes from one rank to another.
  struct Parcel {
    int rank = 0; // the other one
    void* data = nullptr;
    std::size_t bytes = 0;
  };
  // Parcels that one rank sends another arrive in the order they were sent in.
  virtual void exchange(const std::vector<Parcel>& send, const std::vector<Parcel>& receive) = 0;

  // Each has filled its bytes [begin[rank], begin[rank + 1]) of `data`; afterwards all have all.
  virtual void share(void* data, const std::vector<std::size_t>& begin) = 0;

  // Returns what each gives, by rank. Messages on one subject should be about as long as the time before: they are sent
  // in one piece then.
  enum class Subject { any, sums, contacts, pressed, rigid, looks, count };
  virtual std::vector<std::string> gather(const std::string& mine, Subject = Subject::any) = 0;

  // Sends each rank a text of its own, to[rank]; returns what each has sent this one, by rank.
  virtual std::vector<std::string> deal(const std::vector<std::string>& to) = 0;

  // The bytes of rank 0, for all.
  virtual void broadcast(std::string&) = 0;

  // The largest of what each has, entry by entry. No rank may hold a NaN.
  virtual void largest(double* values, std::size_t count) = 0;

  // True where it is so on any rank.
  bool any(bool here) {
    double said = here ? 1 : 0;
    largest(&said, 1);
    return said > 0;
  }

  // Whole numbers, summed over the ranks entry by entry: their order does not matter.
  virtual void sum(std::int64_t* values, std::size_t count) = 0;

  // True where all ranks come to this call within so many seconds. A rank that has an error asks it before anything else,
  // since the others may go on and wait for it elsewhere. Then it returns false, and every call above does nothing from
  // there on and gives this rank what it has itself; it must end all.
  virtual bool all_fail(double seconds) = 0;
  static constexpr double patience = 6; // s: ranks that all fail come so far apart at most

  // Ends all ranks with this exit code, wherever they are. For errors that the others cannot know of.
  [[noreturn]] virtual void abort(int exit_code) = 0;

  // Messages sent since the program began, and the time spent waiting for other ranks.
  struct Traffic {
    std::int64_t messages = 0, bytes = 0;
    double waited = 0;           // s, by the clock
    double waited_processor = 0; // s, of processor time of the thread that waits
  };
  const Traffic& traffic() const { return traffic_; }

protected:
  Ranks(int rank, int size) : rank_(rank), size_(size) {}
  Traffic traffic_;

private:
  int rank_, size_;
};

// Those of this process: one alone unless it has joined others.
Ranks& ranks();

// While it lives this process counts as one alone: what it does then the others neither see nor wait for.
class AloneForNow {
public:
  AloneForNow();
  ~AloneForNow();
  AloneForNow(const AloneForNow&) = delete;
  AloneForNow& operator=(const AloneForNow&) = delete;
};

// How many processes mpirun, srun or their like have started this one among; 1 when by itself.
int processes_started();

// Path of the module cdem_mpi beside the program; "" where it was built without MPI.
std::string module_of_ranks();

// Joins the others that processes_started tells of, by the module cdem_mpi beside the program. Throws
// std::runtime_error, one line, where there is no such module or it is one of another MPI than the one that started it.
void join_ranks();

// Says good-bye to the others; the process is alone afterwards.
void leave_ranks();

} // namespace cdem
