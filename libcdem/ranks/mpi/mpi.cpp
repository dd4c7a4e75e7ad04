// The ranks of an MPI job, as a module that the program loads only where it has been started as one of several
// processes: without MPI it runs as ever. The only file that sees mpi.h.
#include "libcdem/ranks/ranks.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <ctime>
#include <mpi.h>
#include <thread>

namespace {

constexpr std::size_t largest_slot = std::size_t{1} << 24; // bytes
constexpr std::size_t most_at_once = std::size_t{1} << 30; // bytes, as MPI counts in int

class MpiRanks : public cdem::Ranks {
public:
  MpiRanks(int rank, int size) : Ranks(rank, size) { MPI_Comm_dup(MPI_COMM_WORLD, &of_failures_); }
  ~MpiRanks() override {
    MPI_Comm_free(&of_failures_);
    MPI_Finalize();
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  void exchange(const std::vector<Parcel>& send, const std::vector<Parcel>& receive) override {
    if (lost_)
      return;
    const Waiting waiting(*this);
    requests_.clear();
    for (const Parcel& parcel : receive)
      in_slices(parcel.bytes, [&](std::size_t begin, int bytes) {
        MPI_Irecv(static_cast<char*>(parcel.data) + begin, bytes, MPI_BYTE, parcel.rank, 0, MPI_COMM_WORLD,
                  &requests_.emplace_back());
      });
    for (const Parcel& parcel : send) {
      count(parcel.bytes, 1);
      in_slices(parcel.bytes, [&](std::size_t begin, int bytes) {
        MPI_Isend(static_cast<const char*>(parcel.data) + begin, bytes, MPI_BYTE, parcel.rank, 0,
                  MPI_COMM_WORLD, &requests_.emplace_back());
      });
    }
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  }

  void share(void* data, const std::vector<std::size_t>& begin) override {
    if (lost_)
      return;
    const Waiting waiting(*this);
    count(begin[rank() + 1] - begin[rank()], size() - 1);
    if (begin.back() <= most_at_once) {
      std::vector<int> counts(size()), places(size());
      for (int r = 0; r < size(); ++r) {
        counts[r] = static_cast<int>(begin[r + 1] - begin[r]);
        places[r] = static_cast<int>(begin[r]);
      }
      MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, data, counts.data(), places.data(), MPI_BYTE,
                     MPI_COMM_WORLD);
      return;
    }
    for (int r = 0; r < size(); ++r)
      in_slices(begin[r + 1] - begin[r], [&](std::size_t at, int bytes) {
        MPI_Bcast(static_cast<char*>(data) + begin[r] + at, bytes, MPI_BYTE, r, MPI_COMM_WORLD);
      });
  }

  // In one message where all fit into the slot that fitted those before them, which is the same for all ranks; what does
  // not comes in a second one.
  std::vector<std::string> gather(const std::string& mine, Subject subject) override {
    if (lost_)
      return std::vector<std::string>(size(), mine);
    std::size_t& slot = slots_[static_cast<std::size_t>(subject)];
    const std::size_t head = sizeof(std::uint64_t), whole = head + slot;
    std::vector<std::uint64_t> sizes(size());
    std::vector<std::string> texts(size());
    buffer_.resize(whole * static_cast<std::size_t>(size()));
    {
      const Waiting waiting(*this);
      char* const own = buffer_.data() + whole * static_cast<std::size_t>(rank());
      const std::uint64_t bytes = mine.size();
      std::memcpy(own, &bytes, head);
      std::copy_n(mine.data(), std::min(mine.size(), slot), own + head);
      count(whole, size() - 1);
      MPI_Allgather(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, buffer_.data(), static_cast<int>(whole), MPI_BYTE,
                    MPI_COMM_WORLD);
    }
    std::vector<std::size_t> begin(size() + 1, 0);
    for (int r = 0; r < size(); ++r) {
      const char* const at = buffer_.data() + whole * static_cast<std::size_t>(r);
      std::memcpy(&sizes[r], at, head);
      texts[r].assign(at + head, std::min<std::size_t>(sizes[r], slot));
      begin[r + 1] = begin[r] + sizes[r] - texts[r].size();
    }
    if (begin.back() > 0) {
      std::string rest(begin.back(), '\0');
      if (mine.size() > slot)
        std::copy(mine.begin() + static_cast<std::ptrdiff_t>(slot), mine.end(),
                  rest.begin() + static_cast<std::ptrdiff_t>(begin[rank()]));
      share(rest.data(), begin);
      for (int r = 0; r < size(); ++r)
        texts[r].append(rest, begin[r], begin[r + 1] - begin[r]);
    }
    const std::size_t most = *std::max_element(sizes.begin(), sizes.end());
    if (most > slot || 4 * most < slot)
      slot = std::min(largest_slot, most + most / 4 + 64);
    return texts;
  }

  std::vector<std::string> deal(const std::vector<std::string>& to) override {
    std::vector<std::string> from(size());
    from[rank()] = to[rank()];
    if (lost_)
      return from;
    std::vector<unsigned long long> sent(size()), received(size());
    for (int r = 0; r < size(); ++r)
      sent[r] = to[r].size();
    {
      const Waiting waiting(*this);
      MPI_Alltoall(sent.data(), 1, MPI_UNSIGNED_LONG_LONG, received.data(), 1, MPI_UNSIGNED_LONG_LONG,
                   MPI_COMM_WORLD);
    }
    std::vector<Parcel> out, in;
    for (int r = 0; r < size(); ++r) {
      if (r == rank())
        continue;
      if (sent[r] > 0) // it is only read
        out.push_back({r, const_cast<char*>(to[r].data()), to[r].size()});
      from[r].resize(received[r]);
      if (received[r] > 0)
        in.push_back({r, from[r].data(), from[r].size()});
    }
    exchange(out, in);
    return from;
  }

  void broadcast(std::string& text) override {
    if (lost_)
      return;
    const Waiting waiting(*this);
    unsigned long long bytes = text.size();
    MPI_Bcast(&bytes, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    text.resize(bytes);
    in_slices(bytes, [&](std::size_t begin, int size) {
      MPI_Bcast(text.data() + begin, size, MPI_BYTE, 0, MPI_COMM_WORLD);
    });
    if (leads())
      count(bytes, size() - 1);
  }

  void largest(double* values, std::size_t number) override { reduce(values, number, MPI_DOUBLE, MPI_MAX); }
  void sum(std::int64_t* values, std::size_t number) override {
    reduce(values, number, MPI_INT64_T, MPI_SUM);
  }

  // By messages of their own: the others may be in any other call.
  bool all_fail(double seconds) override {
    if (lost_)
      return false;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(of_failures_, &request);
    int come = 0;
    for (const double start = MPI_Wtime(); come == 0 && MPI_Wtime() - start < seconds;) {
      MPI_Test(&request, &come, MPI_STATUS_IGNORE);
      if (come == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    lost_ = come == 0;
    return !lost_;
  }

  [[noreturn]] void abort(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

private:
  class Waiting {
  public:
    explicit Waiting(MpiRanks& ranks) : ranks_(ranks), start_(MPI_Wtime()), processor_(processor_time()) {}
    ~Waiting() {
      ranks_.traffic_.waited += MPI_Wtime() - start_;
      ranks_.traffic_.waited_processor += processor_time() - processor_;
    }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;

  private:
    static double processor_time() {
      timespec t{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
      return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    MpiRanks& ranks_;
    double start_, processor_; // s
  };

  template <class Number>
  void reduce(Number* values, std::size_t number, MPI_Datatype type, MPI_Op how) {
    if (lost_)
      return;
    const Waiting waiting(*this);
    count(number * sizeof(Number), size() - 1);
    in_slices(number, [&](std::size_t begin, int part) {
      MPI_Allreduce(MPI_IN_PLACE, values + begin, part, type, how, MPI_COMM_WORLD);
    });
  }

  void count(std::size_t bytes, int receivers) {
    traffic_.messages += receivers;
    traffic_.bytes += static_cast<std::int64_t>(bytes) * receivers;
  }

  template <class Act>
  static void in_slices(std::size_t size, const Act& act) {
    for (std::size_t begin = 0; begin < size; begin += most_at_once)
      act(begin, static_cast<int>(std::min(size - begin, most_at_once)));
  }

  MPI_Comm of_failures_ = MPI_COMM_NULL; // of all_fail alone
  bool lost_ = false;                    // this rank has failed by itself
  std::vector<MPI_Request> requests_;
  std::vector<char> buffer_;
  std::array<std::size_t, static_cast<std::size_t>(Subject::count)> slots_{}; // bytes
};

} // namespace

// ranks.cpp compares it with its own: a module of another build would have other members in other places.
extern "C" const char cdem_declaration_of_ranks[] = CDEM_DECLARATION_OF_RANKS;

// Errors of MPI itself end the job, which is what MPI does unasked.
extern "C" cdem::Ranks* cdem_join_ranks() {
  int granted = 0, rank = 0, size = 1;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &granted);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return new MpiRanks(rank, size);
}
