-- Does the crack's path depend on the first mesh, or on what was chosen for its growth? Cases of case.lua side by side.
--
--   ./cdem run examples/notched_beam/study.lua                        # first meshes
--   ./cdem run examples/notched_beam/study.lua --set group=faces      # first meshes, ends held by faces
--   ./cdem run examples/notched_beam/study.lua --set group=choices    # one choice changed at a time, 41 x 10 blocks
--   ./cdem run examples/notched_beam/study.lua --set group=anchor     # a cut plane through the tip, or not
--   ./cdem run examples/notched_beam/study.lua --set group=supports
local cdem = require "cdem"
local beam = require "beam"
local crack = require "path"

local groups = {
  meshes = { -- the longest first
    { label = "82 x 20", set = { mesh = "82x20" } }, { label = "41 x 10", set = { mesh = "41x10" } },
    { label = "21 x 5", set = { mesh = "21x5" } }, { label = "turned by 15 deg", set = { mesh = "turned" } },
    { label = "Voronoi 1", set = { mesh = "voronoi", seed = 1 } }, { label = "Voronoi 2", set = { mesh = "voronoi", seed = 2 } },
    { label = "Voronoi 3", set = { mesh = "voronoi", seed = 3 } },
  },
  faces = { -- the same where no support depends on the mesh as a held edge does
    { label = "turned by 15 deg", set = { mesh = "turned", support = "face" } },
    { label = "41 x 10", set = { mesh = "41x10", support = "face" } },
    { label = "21 x 5", set = { mesh = "21x5", support = "face" } },
    { label = "Voronoi 2", set = { mesh = "voronoi", seed = 2, support = "face" } },
    { label = "Voronoi 3", set = { mesh = "voronoi", seed = 3, support = "face" } },
  },
  choices = {
    { label = "as it is", set = {} },
    { label = "judged by the block", set = { judged_by = "block" } },
    { label = "stress within 0.015 m", set = { tip_radius = 0.015 } },
    { label = "stress within 0.06 m", set = { tip_radius = 0.06 } },
    { label = "joints 4 x thinner", set = { thickness_ratio = 0.005 } },
    { label = "joints 2.5 x thicker", set = { thickness_ratio = 0.05 } },
  },
  supports = {
    { label = "pinned", set = {} }, { label = "face", set = { support = "face" } },
    { label = "roller, 5 kN", set = { support = "roller", load = 5e3, passes = 8 } }, -- else it comes apart
  },
  anchor = {
    { label = "anchored", set = {} }, { label = "not anchored", set = { anchored = false } },
    { label = "Voronoi, anchored", set = { mesh = "voronoi" } },
    { label = "Voronoi, not anchored", set = { mesh = "voronoi", anchored = false } },
  },
  quick = { { label = "21 x 5", set = { mesh = "21x5" } }, { label = "21 x 5, thick joints",
                                                           set = { mesh = "21x5", thickness_ratio = 0.05 } } },
}
local group = cdem.parameter{ name = "group", default = "meshes",
                              choices = { "meshes", "faces", "choices", "anchor", "supports", "quick" },
                              doc = "what is compared; quick: two small cases" }
local cases = groups[group]
local coarsest = (group == "choices" or group == "anchor") and 0.03 or 0.06 -- m, edge of the largest block

local sets = {}
for i, case in ipairs(cases) do sets[i] = case.set end
local lines, results = {}, cdem.sweep{ script = "case.lua", set = sets }
for i, result in ipairs(results) do
  if result.exit_code ~= 0 then error(cases[i].label .. " ended with exit code " .. result.exit_code) end
  if result.figures.steps then
    local columns = cdem.read_csv(result.output .. "/path.csv")
    lines[i] = {}
    for k, x in ipairs(columns.x_m) do lines[i][k] = {x, columns.y_m[k]} end
  else -- a case that was only checked has written nothing
    lines[i] = beam.hoop_stress_path[cases[i].set.support or "pinned"]
  end
end

-- Every two of them, and each against the path of the largest hoop stress.
local pairs_csv = { one = {}, other = {}, rms = {}, most = {} }
local worst = { rms = 0, most = 0 }
for i = 1, #lines do
  for j = i + 1, #lines do
    local rms, most = crack.distance(lines[i], lines[j])
    local n = #pairs_csv.one + 1
    pairs_csv.one[n], pairs_csv.other[n], pairs_csv.rms[n], pairs_csv.most[n] = i, j, rms, most
    worst.rms, worst.most = math.max(worst.rms, rms), math.max(worst.most, most)
    cdem.log(string.format("%s - %s: rms %.4f m, at most %.4f m", cases[i].label, cases[j].label, rms, most))
  end
end
cdem.write_csv{ file = "distances.csv", columns = {
  { name = "case", values = pairs_csv.one }, { name = "other_case", values = pairs_csv.other },
  { name = "rms_m", values = pairs_csv.rms }, { name = "largest_m", values = pairs_csv.most } } }

local columns = { case = {}, tip_x = {}, tip_y = {}, rms = {}, most = {}, start = {}, turns = {}, length = {} }
local low, high = {math.huge, math.huge}, {-math.huge, -math.huge}
for i, line in ipairs(lines) do
  local tip = line[#line]
  columns.case[i], columns.tip_x[i], columns.tip_y[i] = i, tip[1], tip[2]
  columns.rms[i], columns.most[i] = crack.distance(line, beam.hoop_stress_path[cases[i].set.support or "pinned"])
  columns.start[i] = results[i].figures.load_that_starts_the_crack_N or 0 / 0
  columns.turns[i], columns.length[i] = crack.wandering(line)
  for k = 1, 2 do low[k], high[k] = math.min(low[k], tip[k]), math.max(high[k], tip[k]) end
  cdem.log(string.format("%d, %s: tip (%.4f, %.4f) m; from the hoop stress path rms %.4f m, at most %.4f m; turns %.0f deg", i,
                         cases[i].label, tip[1], tip[2], columns.rms[i], columns.most[i], columns.turns[i]))
end
cdem.write_csv{ file = "cases.csv", columns = {
  { name = "case", values = columns.case }, { name = "tip_x_m", values = columns.tip_x },
  { name = "tip_y_m", values = columns.tip_y }, { name = "rms_to_hoop_stress_m", values = columns.rms },
  { name = "largest_to_hoop_stress_m", values = columns.most },
  { name = "sum_of_turns_deg", values = columns.turns }, { name = "length_over_straight_way", values = columns.length },
  { name = "load_that_starts_the_crack_N", values = columns.start } } }

-- One picture, as wide as it is high: the beam between its edges, where the cracks run.
local colours = { {0.85, 0.10, 0.10}, {0.00, 0.27, 0.55}, {0.20, 0.55, 0.25}, {0.90, 0.50, 0.00}, {0.45, 0.25, 0.65},
                  {0.00, 0.60, 0.65}, {0.75, 0.30, 0.60}, {0.45, 0.45, 0.10} }
local series = {}
local function draw(line, label, colour, style)
  local x, y = {}, {}
  for i, p in ipairs(line) do x[i], y[i] = p[1], p[2] end
  series[#series + 1] = { name = label, x = x, y = y, colour = colour, style = style }
end
for i, line in ipairs(lines) do draw(line, cases[i].label, colours[i], "line") end
if group == "supports" then
  for i, case in ipairs(cases) do
    local support = case.set.support or "pinned"
    draw(beam.hoop_stress_path[support], "largest hoop stress, " .. support, colours[i], "dashed")
  end
else
  draw(beam.hoop_stress_path[cases[1].set.support or "pinned"], "largest hoop stress", {0, 0, 0}, "dashed")
end
draw(beam.reference, "reference points", {0.5, 0.5, 0.5}, "dashed")
draw({ {0, 0}, {beam.length, 0}, {beam.length, beam.height}, {0, beam.height}, {0, 0} }, "outline of the beam", {0, 0, 0}, "line")
cdem.chart{ file = "paths.png", title = "Paths of the crack", series = series, x_label = "x (m)", y_label = "y (m)",
            x_range = {0.4, 0.7}, y_range = {-0.02, 0.32}, size = {1440, 1600}, legend = "bottom_right" }

local one_path = group ~= "supports" or nil -- other supports, other paths
cdem.report{
  { name = "cases", value = #cases },
  { name = "largest_distance_between_paths_m", value = worst.most, unit = "m", reference = one_path and 0,
    kind = one_path and "formula", source = one_path and "under one block of the coarsest mesh",
    tolerance_absolute = one_path and coarsest },
  { name = "largest_rms_distance_between_paths_m", value = worst.rms, unit = "m" },
  { name = "spread_of_tips_x_m", value = high[1] - low[1], unit = "m" },
  { name = "spread_of_tips_y_m", value = high[2] - low[2], unit = "m" },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
