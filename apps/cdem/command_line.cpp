#include "apps/cdem/command_line.hpp"

#include "apps/cdem/build_info.hpp"
#include "apps/cdem/commands/commands.hpp"
#include "apps/cdem/failure.hpp"
#include "apps/cdem/memory.hpp"
#include "apps/cdem/option_values.hpp"
#include "apps/cdem/ranks/start_ranks.hpp"
#include "apps/cdem/shell/shell_files.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "lua/binding/schema/nearest.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace cdem::app {

namespace {

constexpr int most_threads = 1024;
constexpr int most_points = 100000;
constexpr const char* threads_text =
    "threads (every core, shared among the ranks); results are the same bits for any number";

// Everything that can be typed, as typed.
struct Typed {
  std::string file, output, threads, ranks, memory, jobs, colour,
      deformation = "0", view = "front", up = "y", size = "1600x1200", range, hidden, colour_map = "auto",
      title, topic, checkpoint_every = "10", sources, shell_files, dpi = "300", point;
  std::vector<std::string> set;
  bool slurm = false, unsafe = false, quiet = false, machine = false, live = false, version = false,
       manual = false;
  bool no_edges = false, no_broken_bonds = false, no_colour_bar = false, no_legend = false, no_axes = false;
};

// "Usage: cdem run [OPTIONS] FILE" and plain lower-case headings in a narrow column.
class HelpFormatter : public CLI::Formatter {
public:
  HelpFormatter() { column_width(30); }
  // One short and one long name: the American spellings work, and need no room here.
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    if (positional)
      return option->get_name(true);
    const auto &shorts = option->get_snames(), &longs = option->get_lnames();
    return (shorts.empty() ? "    " : "-" + shorts.front() + ", ") + "--" + longs.front();
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_option_text().empty() ? "" : " " + option->get_option_text();
  }
  std::string make_usage(const CLI::App* app, std::string) const override {
    std::string name = app->get_name();
    for (const auto* parent = app->get_parent(); parent != nullptr; parent = parent->get_parent())
      name = parent->get_name() + " " + name;
    std::string usage = "\nusage: " + name;
    if (!app->get_subcommands([](const CLI::App*) { return true; }).empty())
      return usage + " COMMAND [...]\n";
    for (const auto* option : app->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      usage += " " + option->get_name(true);
    return usage + " [OPTIONS]\n";
  }
};

class Parser {
public:
  Parser()
      : app_("cdem: continuum-based discrete element method.\n"
             "Lua scripts build assemblies of deformable blocks, load and break them, and write pictures,\n"
             "ParaView files and a report into results/.",
             "cdem") {
    app_.formatter(std::make_shared<HelpFormatter>());
    app_.set_help_flag("-h,--help", "print this help and exit")->group("options");
    app_.allow_extras();
    app_.require_subcommand(0, 1);
    app_.get_formatter()->label("Positionals", "arguments");
    app_.option_defaults()->group("options");
    app_.add_flag("--version", typed_.version, "print the version and exit");
    app_.add_flag("--manual", typed_.manual, "print the help of every command as Markdown")->group("");
    app_.add_option("--shell-files", typed_.shell_files, "folder for manual pages and completion")->group("");
    add_run();
    add_resume();
    add_check();
    add_sweep();
    add_render();
    add_view();
    add_info();
    add_repl();
    add_annotations();
    auto* help = app_.add_subcommand("help", "print the help of a command");
    finish(help, "");
    help->add_option("[COMMAND]", typed_.topic, "run, check, ...");
    app_.footer(
        "examples:\n"
        "  cdem run examples/uniaxial_compression/case.lua\n"
        "  cdem run case.lua --set pressure=24e6 --threads 2 --output results/gentle\n"
        "  cdem resume results/gentle\n"
        "  cdem check case.lua\n"
        "  cdem sweep case.lua --set pressure=20e6,25e6,30e6 --jobs 2\n"
        "  cdem render results/plate/result.vtu --colour displacement.x --deformation 20\n"
        "  cdem help run\n"
        "\n"
        "environment:\n"
        "  CDEM_INSTRUCTION_SET        baseline, avx2 or avx512: what kernels run with (the widest that the\n"
        "                              processor has); results are the same bits for every one\n"
        "\n"
        "exit codes:\n" +
        exit_code_table());
  }

  std::function<ExitCode()> parse(int argc, const char* const* argv) {
    words_.assign(argv + std::min(1, argc), argv + argc);
    for (int i = 0; i < argc; ++i)
      line_ += (i == 0 ? "cdem" : std::string(" ") + argv[i]);
    try {
      app_.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
      const auto chosen = app_.get_subcommands();
      return print(chosen.empty() ? help_of(&app_) : help_of(chosen.front()));
    } catch (const CLI::ArgumentMismatch& error) {
      const std::string text = error.what(); // "--threads: 1 required TEXT missing"
      throw UsageError(text.substr(0, text.find(':')) + ": its value is missing");
    } catch (const CLI::ParseError& error) {
      throw UsageError(error.what());
    }
    return action();
  }

  std::string manual() {
    std::string text = "# Command line\n\n"
                       "What `cdem --help` and `cdem help COMMAND` print. Exit codes are explained in\n"
                       "[exit-codes.md](exit-codes.md).\n";
    const auto add = [&](const std::string& title, CLI::App* app) {
      std::string help = help_of(app);
      text += "\n## " + title + "\n\n```text\n" + help + "```\n";
    };
    add("cdem", &app_);
    for (const auto& name : command_names())
      if (name != "help")
        add("cdem " + name, app_.get_subcommand(name));
    return text;
  }

private:
  using Action = std::function<ExitCode()>;

  static Action print(std::string text) {
    return [text = std::move(text)] {
      std::fputs(text.c_str(), stdout);
      return ExitCode::success;
    };
  }

  static std::string help_of(CLI::App* app) {
    std::string text = app->help();
    // No blank lines at either end, one between parts.
    text.erase(0, text.find_first_not_of('\n'));
    while (!text.empty() && text.back() == '\n')
      text.pop_back();
    for (auto at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n"))
      text.erase(at, 1);
    return text + "\n";
  }

  std::vector<std::string> command_names() const {
    std::vector<std::string> names;
    for (const auto* command : app_.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name());
    return names;
  }

  void finish(CLI::App* command, const std::string& examples, const std::string& notes = {}) {
    command->group("commands");
    command->set_help_flag("-h,--help", "print this help and exit");
    command->allow_extras();
    if (!examples.empty())
      command->footer("examples:\n" + examples + (notes.empty() ? notes : "\n" + notes));
  }

  void add_script_options(CLI::App* command) {
    command->add_option("FILE", typed_.file, "the case script, a .lua file")->option_text(" ");
    add_unsafe(command);
  }
  void add_unsafe(CLI::App* command) {
    command->add_flag("--unsafe", typed_.unsafe,
                      "let the script use all of Lua and any file (trusted scripts only)");
  }
  void add_set(CLI::App* command, const std::string& form, const std::string& text) {
    command->add_option("--set", typed_.set, text)->option_text(form)->allow_extra_args(false);
  }
  void add_threads(CLI::App* command, const std::string& text) {
    command->add_option("--threads", typed_.threads, text)->option_text("N");
  }
  void add_ranks(CLI::App* command) {
    command
        ->add_option("--ranks", typed_.ranks,
                     "processes that solve the model together, by mpirun (1); the same bits for any number")
        ->option_text("N");
  }
  void add_memory(CLI::App* command) {
    command
        ->add_option("--memory", typed_.memory,
                     "the most it may take, as in 12G or 800M (nine tenths of the machine's)")
        ->option_text("SIZE");
  }
  void add_output(CLI::App* command, const std::string& form, const std::string& text) {
    command->add_option("--output,-o", typed_.output, text)->option_text(form);
  }

  void add_run() {
    auto* command = app_.add_subcommand("run", "run a case script");
    add_script_options(command);
    add_output(command, "DIR", "folder for results and log (results/<case>)");
    add_threads(command, threads_text);
    add_ranks(command);
    add_memory(command);
    add_set(command, "NAME=VALUE", "value of a parameter of the script; may be repeated");
    add_checkpoint_every(command);
    add_live(command);
    command->add_flag("--quiet,-q", typed_.quiet, "print nothing but warnings and errors");
    command->add_flag("--machine-progress", typed_.machine, "progress for a program that watches this run")
        ->group("");
    command->add_option("--sources", typed_.sources, "folder with the text of the script that a sweep kept")
        ->group("");
    finish(
        command,
        "  cdem run examples/uniaxial_compression/case.lua\n"
        "  cdem run case.lua --set pressure=24e6 --output results/gentle\n",
        "<case> is the name of the script's folder, with -SCRIPT unless it is case.lua, and with the\n"
        "settings: --set pressure=24e6 gives results/uniaxial_compression-pressure=24e6, several are\n"
        "joined by commas in the order of their names. Other characters than letters, digits and +-=.,_\n"
        "become _, and then a short hash keeps cases apart.\n"
        "\n"
        "Once a run writes its first result, it deletes the files of the last run in the same folder. A\n"
        "file that was edited since is kept as FILE.edited. A folder that holds other files than results\n"
        "is refused. Ctrl-C ends a run at the next step, saves the state and writes a checkpoint for cdem\n"
        "resume; a second Ctrl-C ends it at once.\n");
  }
  void add_live(CLI::App* command) {
    command->add_flag("--live", typed_.live,
                      "show the run in a browser page of this machine; its address is printed");
  }
  void add_checkpoint_every(CLI::App* command) {
    command
        ->add_option("--checkpoint-every", typed_.checkpoint_every,
                     "minutes between checkpoints in a long stage (10); 0: none")
        ->option_text("MINUTES");
  }
  void add_resume() {
    auto* command = app_.add_subcommand("resume", "continue a run that was stopped or killed");
    command->add_option("FOLDER", typed_.file, "its output folder")->option_text(" ");
    add_unsafe(command);
    add_threads(command, threads_text);
    add_ranks(command);
    add_memory(command);
    add_checkpoint_every(command);
    add_live(command);
    command->add_flag("--quiet,-q", typed_.quiet, "print nothing but warnings and errors");
    finish(
        command, "  cdem resume results/uniaxial_compression\n  cdem resume results/plate --threads 8\n",
        "Continues from the newest intact checkpoint in the folder, with the script and the settings of the\n"
        "run. The result is the same, bit for bit, as that of a run that was never stopped. The script runs\n"
        "from its beginning; calls before the checkpoint return their recorded results and do nothing. So\n"
        "the script must not have changed. There is one exception, a run that ended with an error of its\n"
        "script (exit code 2 or 4): correct the script; it may change after the last solved stage, or in\n"
        "the callback that failed. A run that was started with --unsafe needs it again. A run that ends "
        "well\n"
        "deletes its checkpoints.\n");
  }
  void add_check() {
    auto* command =
        app_.add_subcommand("check", "build and validate what a script describes, without solving");
    add_script_options(command);
    add_threads(command, "threads (every core)");
    add_memory(command);
    add_set(command, "NAME=VALUE", "value of a parameter of the script; may be repeated");
    finish(
        command, "  cdem check case.lua --set pressure=24e6\n",
        "Prints the parameters, the parts of each model, its box from corner to corner, conditions and\n"
        "stages. Solving calls call their callbacks once and return empty results; what the script prints\n"
        "after the first of them is left out. No file is written.\n");
  }
  void add_sweep() {
    auto* command =
        app_.add_subcommand("sweep", "run a script with every combination of values, side by side");
    add_script_options(command);
    add_set(command, "NAME=A,B,...", "values of a parameter of the script; may be repeated");
    command->add_option("--jobs,-j", typed_.jobs, "runs side by side (one a core)")->option_text("N");
    add_threads(command, "threads of each run (the cores shared among the jobs)");
    add_memory(command);
    add_output(command, "DIR", "folder for the runs, sweep.csv and charts of it (results/<case>-sweep)");
    command->add_flag("--slurm", typed_.slurm, "run nothing; write DIR/sweep.sbatch, a job array for sbatch");
    command->add_option("--ranks", typed_.ranks, "with --slurm: processes that solve each run together (1)")
        ->option_text("N");
    command->add_option("--point", typed_.point, "the run that a task of the array is for")->group("");
    command->add_flag("--quiet,-q", typed_.quiet, "print nothing but warnings and errors");
    finish(
        command, "  cdem sweep case.lua --set pressure=20e6,25e6,30e6 --set cohesion=5e6,8e6 --jobs 2\n",
        "All runs use the script, and the files that it requires by a name in quotes, as they are when the\n"
        "sweep begins; the folder keeps copies in swept/. Data files are read when a run reads them.\n"
        "\n"
        "--slurm writes a job array. The same command again, when jobs have ended, gathers their figures in\n"
        "sweep.csv and writes an array of the rest: docs/cluster.md.\n");
  }
  void add_render() {
    auto* command = app_.add_subcommand("render", "draw a picture of a saved file");
    command->add_option("FILE", typed_.file, "the .vtu or .vtkhdf file")->option_text(" ");
    colour_given_ = command
                        ->add_option("--colour,--color,-c", typed_.colour,
                                     "field to colour by (displacement.magnitude); \"\": plain blocks")
                        ->option_text("FIELD");
    command->add_option("--deformation,-d", typed_.deformation, "scale of the displacement (0: undeformed)")
        ->option_text("S");
    command->add_option("--view,-v", typed_.view, "front, back, left, right, top, bottom or iso (front)")
        ->option_text("VIEW");
    command->add_option("--up", typed_.up, "the axis that points up: y or z (y)")->option_text("AXIS");
    command->add_option("--size,-s", typed_.size, "pixels (1600x1200); WIDTH alone: as high as needed")
        ->option_text("WxH");
    command->add_option("--range,-r", typed_.range, "values at the ends of the colours")
        ->option_text("LOW,HIGH");
    command
        ->add_option("--colour-map,--color-map", typed_.colour_map,
                     "auto, blue_white_red, cool_warm, viridis, grey or categorical (auto)")
        ->option_text("NAME");
    command->add_option("--title,-t", typed_.title, "title of the picture")->option_text("TEXT");
    command
        ->add_option(
            "--hidden", typed_.hidden,
            "bodies to leave out, by name or by number (0 is the first); cdem info FILE.vtu lists them")
        ->option_text("BODY,...");
    command->add_flag("--no-edges", typed_.no_edges, "without the outlines of the blocks");
    command->add_flag("--no-broken-bonds", typed_.no_broken_bonds, "without broken bonds");
    command->add_flag("--no-colour-bar,--no-color-bar", typed_.no_colour_bar, "without the colour bar");
    command->add_flag("--no-legend", typed_.no_legend, "without the legend");
    command->add_flag("--no-axes", typed_.no_axes, "without the axes");
    add_output(command, "FILE",
               "the picture, .png, .svg or .pdf (a .png beside the .vtu, named after it and the field)");
    command->add_option("--dpi", typed_.dpi, "pixels in an inch where the picture is printed (300)")
        ->option_text("N");
    finish(command, "  cdem render results/plate/result.vtu --colour stress.yy --range -40e6,0\n"
                    "  cdem render result.vtu -c displacement.x -d 20 -s 2400x1800 -o ux.png\n");
  }
  void add_view() {
    auto* command = app_.add_subcommand("view", "look at saved files in a browser page of this machine");
    command->add_option("PATH", typed_.file, "a .vtu or .vtkhdf file, a .pvd series or a folder of results")
        ->option_text(" ");
    finish(
        command, "  cdem view results/plate\n  cdem view results/plate/run.pvd\n",
        "Prints the address of a page that shows the model: choose the file, the field and the step, turn\n"
        "and zoom it, play a series. cdem draws each picture, so the browser may be a plain one. The page\n"
        "can be read on this machine only; its button, or Ctrl-C, ends the viewer.\n");
  }
  void add_info() {
    auto* command =
        app_.add_subcommand("info", "describe this program, a saved file, a script or a results folder");
    command
        ->add_option("PATH", typed_.file,
                     "a .vtu or .vtkhdf file, a .lua script or a folder of results; none: this program")
        ->option_text(" ");
    finish(command, "  cdem info\n  cdem info case.lua\n  cdem info results/plate\n");
  }
  void add_repl() {
    auto* command = app_.add_subcommand("repl", "type Lua with the cdem module at hand");
    add_threads(command, "threads (every core)");
    add_memory(command);
    command->add_flag("--unsafe", typed_.unsafe, "all of Lua and any file");
    finish(command,
           "  cdem repl\n  echo 'print(cdem.grid{ size = {1, 1, 1}, divisions = {2, 2, 2} })' | cdem repl\n");
  }
  void add_annotations() {
    auto* command =
        app_.add_subcommand("annotations", "print LuaCATS annotations of the cdem module, for editors");
    finish(command, "  cdem annotations > cdem.lua\n");
  }

  // What the parser left over: the first of it names the mistake.
  void refuse_extras(CLI::App* command) const {
    const auto top = app_.remaining();
    if (command == nullptr) {
      for (const auto& word : top)
        if (!word.empty() && word.front() == '-')
          refuse_option(word, &app_);
      if (!top.empty())
        throw UsageError("no command '" + top.front() + "'" +
                         script::did_you_mean(top.front(), command_names()) +
                         (top.front().size() > 4 && top.front().substr(top.front().size() - 4) == ".lua"
                              ? "; to run a script: cdem run " + top.front()
                              : "; cdem --help lists them"));
      return;
    }
    auto words = command->remaining();
    words.insert(words.end(), top.begin(), top.end());
    for (const auto& word : words)
      if (word.size() > 1 && word.front() == '-')
        refuse_option(word, command);
    if (!words.empty())
      throw UsageError("cdem " + command->get_name() + ": unexpected '" + words.front() + "'; cdem help " +
                       command->get_name() + " lists what it takes");
  }

  static void refuse_option(const std::string& word, const CLI::App* command) {
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string> names;
    for (const auto* option :
         command->get_options([](const CLI::Option* o) { return !o->get_positional(); })) {
      for (const auto& long_name : option->get_lnames())
        names.push_back("--" + long_name);
    }
    const std::string who = command->get_parent() == nullptr ? "cdem" : "cdem " + command->get_name();
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw UsageError("cdem: " + name + " belongs after the command: " + who + " ... " + name);
    throw UsageError(who + ": no option " + name +
                     (name.size() > 2 ? script::did_you_mean(name, names) : std::string()));
  }

  // What does not solve one model is not for several ranks.
  void refuse_ranks(const std::string& command) const {
    for (const char* const name : {"sweep", "render", "view", "repl"})
      if (command == name && typed_.point.empty() && processes_started() > 1)
        throw UsageError("cdem " + command + ": this is one of " + std::to_string(processes_started()) +
                         " ranks that mpirun or srun has started; start it by itself");
  }

  void require_file(const std::string& what, const std::string& command) const {
    if (typed_.file.empty())
      throw UsageError("cdem " + command + ": which file? usage: cdem " + command + " " + what);
  }

  int threads() const {
    return typed_.threads.empty() ? 0 : whole_number("--threads", typed_.threads, 1, most_threads);
  }

  // `here`, or as several ranks that --ranks asks for.
  Action among_ranks(Action here) const {
    const int count = typed_.ranks.empty() ? 1 : whole_number("--ranks", typed_.ranks, 1, most_ranks);
    if (!typed_.ranks.empty() && processes_started() > 1)
      throw UsageError("--ranks " + typed_.ranks + ": this is one of " + std::to_string(processes_started()) +
                       " ranks that mpirun or srun has started; leave --ranks out");
    if (count == 1)
      return here;
    std::vector<std::string> words;
    for (std::size_t i = 0; i < words_.size(); ++i)
      if (words_[i] == "--ranks")
        ++i;
      else if (words_[i].rfind("--ranks=", 0) != 0)
        words.push_back(words_[i]);
    return [count, words] { return start_ranks(count, words); };
  }

  std::size_t memory() const { return typed_.memory.empty() ? 0 : memory_value("--memory", typed_.memory); }

  Action action() {
    const auto chosen = app_.get_subcommands();
    refuse_extras(chosen.empty() ? nullptr : chosen.front());
    if (typed_.version)
      return print("cdem " + version() + "\n");
    if (typed_.manual)
      return print(manual());
    if (!typed_.shell_files.empty())
      return [all = declared(app_), folder = typed_.shell_files] {
        write_shell_files(all, folder);
        return ExitCode::success;
      };
    if (chosen.empty())
      return print(help_of(&app_));
    const std::string command = chosen.front()->get_name();
    refuse_ranks(command);
    if (command == "help")
      return help_action();
    if (command == "run")
      return run_action();
    if (command == "resume")
      return resume_action();
    if (command == "check") {
      require_file("FILE.lua", command);
      return [c = CheckCommand{typed_.file, threads(), settings_of(typed_.set), typed_.unsafe, memory()}] {
        return check(c);
      };
    }
    if (command == "sweep")
      return sweep_action();
    if (command == "render")
      return render_action();
    if (command == "view") {
      require_file("PATH", command);
      return [file = typed_.file] { return view(file); };
    }
    if (command == "info")
      return [file = typed_.file] { return info(file); };
    if (command == "repl")
      return [c = ReplCommand{threads(), typed_.unsafe, memory()}] { return repl(c); };
    return print_annotations;
  }

  Action help_action() {
    if (typed_.topic.empty())
      return print(help_of(&app_));
    for (const auto& name : command_names())
      if (name == typed_.topic)
        return print(help_of(app_.get_subcommand(name)));
    throw UsageError("no command '" + typed_.topic + "'" +
                     script::did_you_mean(typed_.topic, command_names()));
  }

  Action run_action() {
    require_file("FILE.lua", "run");
    RunCommand c;
    c.script = typed_.file;
    c.sources = typed_.sources;
    c.ends_with_parent = !typed_.sources.empty();
    c.output = typed_.output;
    c.threads = threads();
    c.memory = memory();
    c.set = settings_of(typed_.set);
    c.unsafe = typed_.unsafe;
    c.progress = progress_style();
    c.checkpoint_minutes = checkpoint_minutes();
    c.live = typed_.live;
    c.line = line_;
    return among_ranks([c] { return run(c); });
  }

  double checkpoint_minutes() const {
    const double minutes = real_number("--checkpoint-every", typed_.checkpoint_every);
    if (minutes < 0)
      throw UsageError("--checkpoint-every " + typed_.checkpoint_every +
                       ": must be a number of minutes >= 0; 0 writes none");
    return minutes;
  }

  ProgressStyle progress_style() const {
    return typed_.machine ? ProgressStyle::machine
           : typed_.quiet ? ProgressStyle::none
                          : ProgressStyle::automatic;
  }

  Action resume_action() {
    require_file("FOLDER", "resume");
    ResumeCommand c;
    c.folder = typed_.file;
    c.threads = threads();
    c.memory = memory();
    c.unsafe = typed_.unsafe;
    c.progress = progress_style();
    c.checkpoint_minutes = checkpoint_minutes();
    c.live = typed_.live;
    c.line = line_;
    return among_ranks([c] { return resume(c); });
  }

  Action sweep_action() {
    require_file("FILE.lua --set NAME=A,B,...", "sweep");
    if (typed_.set.empty())
      throw UsageError("cdem sweep: nothing varies; give --set NAME=A,B,...");
    SweepCommand c;
    c.script = typed_.file;
    c.output = typed_.output;
    c.settings = combinations_of(typed_.set);
    c.jobs = typed_.jobs.empty() ? 0 : whole_number("--jobs", typed_.jobs, 1, most_threads);
    c.threads = threads();
    c.memory = memory();
    c.unsafe = typed_.unsafe;
    c.quiet = typed_.quiet;
    c.line = line_;
    c.sets = typed_.set;
    c.ranks = typed_.ranks.empty() ? 1 : whole_number("--ranks", typed_.ranks, 1, most_ranks);
    if (!typed_.point.empty())
      return
          [c, point = whole_number("--point", typed_.point, 1, most_points)] { return run_point(c, point); };
    if (typed_.slurm)
      return [c] { return write_job_array(c); };
    if (c.ranks > 1)
      throw UsageError("cdem sweep: --ranks goes with --slurm; here the runs stand side by side (--jobs)");
    return [c] { return sweep(c); };
  }

  Action render_action() {
    require_file("FILE.vtu", "render");
    RenderCommand c;
    c.file = typed_.file;
    c.output = typed_.output;
    if (colour_given_->count() > 0)
      c.colour = typed_.colour;
    c.deformation = real_number("--deformation", typed_.deformation);
    c.view = typed_.view;
    c.up = typed_.up;
    c.size = size_value("--size", typed_.size);
    c.dpi = real_number("--dpi", typed_.dpi);
    if (!typed_.range.empty())
      c.range = range_value("--range", typed_.range);
    if (!typed_.hidden.empty())
      c.hidden = names_value("--hidden", typed_.hidden);
    c.colour_map = typed_.colour_map;
    c.title = typed_.title;
    c.edges = !typed_.no_edges;
    c.broken_bonds = !typed_.no_broken_bonds;
    c.colour_bar = !typed_.no_colour_bar;
    c.legend = !typed_.no_legend;
    c.axes = !typed_.no_axes;
    return [c] { return render_picture(c); };
  }

  CLI::App app_;
  Typed typed_;
  CLI::Option* colour_given_ = nullptr;
  std::vector<std::string> words_; // of the command line behind the program
  std::string line_;               // the command line, for the log
};

} // namespace

std::function<ExitCode()> parse_command_line(int argc, const char* const* argv) {
  return Parser().parse(argc, argv);
}

std::string command_line_manual() {
  return Parser().manual();
}

} // namespace cdem::app
