-- The notched beam as a testing machine loads it: the load line is led down in increments. Load over the opening of the
-- notch's mouth, with brittle joints (grow), and with joints that soften along the path of the brittle crack (relax).
--
--   ./cdem run examples/notched_beam/displacement_control.lua [--set support=pinned] [--set fracture_energy_1=30]
local cdem = require "cdem"
local beam = require "beam"
local crack = require "path"

local support = cdem.parameter{ name = "support", default = "roller", choices = beam.supports, doc = "as in case.lua" }
local last = cdem.parameter{ name = "displacement", default = 3e-4, range = {1e-6, 0.01}, unit = "m",
                             doc = "of the load line at the end" }
local increments = cdem.parameter{ name = "increments", default = 40, range = {1, 10000}, doc = "of the same size" }
local softening = cdem.parameter{ name = "softening", default = true, doc = "the softening beam too, not the brittle one alone" }
local energy_1 = cdem.parameter{ name = "fracture_energy_1", default = 50.0, range = {1, 1e4}, unit = "J/m2", doc = "G_I" }
local energy_2 = cdem.parameter{ name = "fracture_energy_2", default = 200.0, range = {1, 1e5}, unit = "J/m2", doc = "G_II" }

-- Leads the load line down; `advance` brings the crack up to date after each increment. Returns the curve.
local function lead(model, advance)
  local curve = { displacement = {0}, opening = {0}, load = {0} }
  local function note(d)
    curve.displacement[#curve.displacement + 1] = d
    curve.opening[#curve.opening + 1] = beam.crack_mouth_opening(model)
    curve.load[#curve.load + 1] = -model:reaction("load line")[2]
    return curve.load[#curve.load], curve.opening[#curve.opening]
  end
  for i = 1, increments do
    local d = last * i / increments
    model:fix{ on = "load line", axes = "y", displacement = {0, -d, 0} }
    advance(function() return note(d) end)
  end
  return curve
end

local function peak(curve)
  local k = 1
  for i = 1, #curve.load do if curve.load[i] > curve.load[k] then k = i end end
  return curve.load[k], curve.opening[k]
end

local function work(curve)
  local sum = 0
  for i = 2, #curve.load do
    sum = sum + (curve.load[i] + curve.load[i - 1]) / 2 * (curve.displacement[i] - curve.displacement[i - 1])
  end
  return sum
end

local function write(name, curve)
  cdem.write_csv{ file = name .. ".csv", columns = { { name = "displacement_m", values = curve.displacement },
                                                     { name = "opening_m", values = curve.opening },
                                                     { name = "load_N", values = curve.load } } }
end

-- Brittle: balance, then let the crack grow until it stands again. Until something breaks all is in proportion to the
-- displacement, so a state before a break, over the ratio of the worst face's traction to its strength, is the state that
-- just starts the break: these are the points of a test led by the opening itself.
local whole = cdem.mohr_coulomb{ cohesion = 10e6, friction_angle = 30, tensile_strength = 2e6 }
local brittle = beam.model({ { shape = beam.shape("41x10"), material = beam.rock, joint = whole, name = "beam",
                              element = "small_strain" } }, support)
local near_the_top = 0.85 * beam.height -- under the last row of blocks the crack turns aside
local by_opening = { opening = {0}, load = {0} }
local starts
local path = { {beam.notch_x, 0, 0}, {beam.notch_x, beam.notch_height, 0} } -- until something grows; in a check nothing does
local saw = lead(brittle, function(note)
  brittle:relax{ breaking = false, residual = 1e-5 }
  local load, opening = note()
  local growth = brittle:grow{ passes = 100, callback = function(pass)
    if #pass.faces == 0 then return end
    if pass.tip[2] < near_the_top then
      table.insert(by_opening.load, load / pass.first_ratio)
      table.insert(by_opening.opening, opening / pass.first_ratio)
    end
    load, opening = note()
  end }
  if #growth.passes == 0 then return end
  path = growth.passes[#growth.passes].path
  starts = starts or load / growth.passes[1].first_ratio
end)
write("brittle", saw)
local brittle_peak, brittle_opening = peak(saw)
cdem.write_csv{ file = "brittle_by_opening.csv", columns = { { name = "opening_m", values = by_opening.opening },
                                                             { name = "load_N", values = by_opening.load } } }
local function scaled(list, factor)
  local out = {}
  for i, value in ipairs(list) do out[i] = factor * value end
  return out
end
local curves = {}
local function draw(name, curve, style)
  curves[#curves + 1] = { name = name, x = scaled(curve.opening, 1e6), y = scaled(curve.load, 1e-3), style = style }
end
draw("brittle, led by the displacement", saw, "line")
draw("brittle, led by the opening", by_opening, "both")

-- The path as far as it rises.
local line = {path[1]}
for i = 2, #path do
  if path[i][2] <= line[#line][2] or path[i][2] > near_the_top then break end
  line[i] = path[i]
end
local tip = line[#line]
local figures = {
  { name = "load_that_starts_the_crack_N", value = starts, unit = "N",
    source = "first increment: load over the ratio of the worst face's traction to its strength" },
  { name = "brittle_peak_load_N", value = brittle_peak, unit = "N" },
  { name = "brittle_peak_opening_m", value = brittle_opening, unit = "m" },
  { name = "crack_tip_x_m", value = tip[1], unit = "m", source = "where the brittle crack's path ends" },
  { name = "crack_tip_y_m", value = tip[2], unit = "m" },
}
brittle:picture{ file = "brittle.png", colour = "displacement.x", deformation = 200, size = {1600, 0},
                 title = "Brittle joints, at the end" }

-- The beam in two bodies, left and right of the path of the crack, and from its end straight up.
local function two_halves()
  line[#line + 1] = {tip[1], beam.height, 0}
  local shape = beam.shape("41x10")
  for i = 2, #line do
    local a, b = line[i - 1], line[i]
    local pieces = b[2] > beam.notch_height + 1e-9 and 20 or 0 -- each in one block or along its sides
    for k = 1, pieces do
      local t = (k - 0.5) / pieces
      local x, y = a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])
      shape = cdem.cut_by_plane{ shape = shape, point = a, normal = {b[2] - a[2], a[1] - b[1], 0},
                                 crossing = { min = {x - 1e-6, y - 1e-6, 0}, max = {x + 1e-6, y + 1e-6, beam.depth} } }
    end
  end
  local left, right = {}, {}
  for _, block in ipairs(shape:blocks()) do
    local c = block.centroid
    local half = c[1] < crack.x_at(line, c[2]) and left or right
    half[#half + 1] = cdem.keep{ shape = shape, inside = { min = {c[1] - 1e-6, c[2] - 1e-6, 0},
                                                           max = {c[1] + 1e-6, c[2] + 1e-6, beam.depth} } }
  end
  return cdem.merge{ shapes = left }, cdem.merge{ shapes = right }
end

if softening then
  local left, right = two_halves()
  local strong = cdem.mohr_coulomb{ cohesion = 1e12, friction_angle = 30, tensile_strength = 1e12 } -- does not break
  local soft = cdem.mohr_coulomb{ cohesion = 10e6, friction_angle = 30, tensile_strength = 2e6, softening = "exponential",
                                  fracture_energy_1 = energy_1, fracture_energy_2 = energy_2 }
  local model = beam.model({ { shape = left, material = beam.rock, joint = strong, name = "left",
                               element = "small_strain" },
                             { shape = right, material = beam.rock, joint = strong, name = "right",
                               element = "small_strain" } }, support,
                           { { "left", "right", soft } })
  local first
  local fall = lead(model, function(note)
    model:relax{ residual = 1e-5 }
    note()
    local counts = model:counts()
    if not first and counts.damaged + counts.broken_tension + counts.broken_shear > 0 then
      first = -model:reaction("load line")[2]
    end
  end)
  write("softening", fall)
  local load, opening = peak(fall)
  draw(string.format("softening, G_{I} = %g J/m^{2}", energy_1), fall, "both")
  local area = 0 -- that has separated, m2
  for _, b in ipairs(model:breaks()) do area = area + b.area end
  local energy = model:energy()
  local ends = -model:reaction("load line")[2] * last / 2 -- stored at the end, were it to unload to the origin
  for _, figure in ipairs{
    { name = "softening_first_damage_load_N", value = first, unit = "N", source = "load at the end of that increment" },
    { name = "softening_peak_load_N", value = load, unit = "N" },
    { name = "softening_peak_opening_m", value = opening, unit = "m" },
    { name = "softening_separated_area_m2", value = area, unit = "m2" },
    { name = "softening_breaking_J", value = energy.breaking, unit = "J" },
    { name = "softening_work_less_stored_J", value = work(fall) - ends, unit = "J", reference = energy.breaking,
      kind = "formula", source = "area under the curve, unloading to the origin; the rest went into damping" },
    { name = "energy_balance_error", value = energy.balance_error, reference = 0, kind = "formula",
      source = "energy is conserved", tolerance_absolute = 0.01 } } do
    figures[#figures + 1] = figure
  end
  model:picture{ file = "softening.png", colour = "displacement.x", deformation = 200, size = {1600, 0},
                 title = "Softening joints, at the end" }
end

cdem.chart{ file = "load_opening.png", title = "Load over the opening of the notch's mouth, " .. support .. " support",
            series = curves, x_label = "crack mouth opening (\u{3bc}m)", y_label = "load (kN)", size = {1600, 1000} }
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
