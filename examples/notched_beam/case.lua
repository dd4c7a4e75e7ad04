-- Han 2010, example 4.2: an off-centre notch in a bent beam; the crack finds its way to the load.
--
--   ./cdem run examples/notched_beam/case.lua [--set passes=3] [--set support=faces]
local cdem = require "cdem"

local load = cdem.parameter{ name = "load", default = 2.5e4, range = {0, 1e9}, unit = "N", doc = "downward, at mid-span" }
local passes = cdem.parameter{ name = "passes", default = 40, range = {0, 1000}, doc = "at most; the paper's three: 3" }
local support = cdem.parameter{ name = "support", default = "edges", choices = {"edges", "faces"},
                                doc = "bottom end edges, or the whole bottom faces of the end blocks" }

local length, height, depth, notch_x, notch_y, block = 1.23, 0.30, 0.03, 0.435, 0.03, 0.03 -- m
local rock = cdem.elastic{ youngs_modulus = 27.4e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 10e6, friction_angle = 30, tensile_strength = 2e6 }

-- 410 cubes; the notch falls into the middle of a column, whose lowest block is cut in two.
local beam = cdem.cut_by_plane{ shape = cdem.grid{ size = {length, height, depth}, divisions = {41, 10, 1} },
                                point = {notch_x, 0, 0}, normal = {1, 0, 0},
                                crossing = { min = {notch_x - 1e-4, 0, 0}, max = {notch_x + 1e-4, notch_y, depth} } }
local model = cdem.model{ bodies = { { shape = beam, material = rock, joint = joint, name = "beam" } } }

local reach = support == "faces" and block or 0
model:fix{ on = {"z-", "z+"}, axes = "z" }
model:fix{ on = cdem.select.where(function(x, y) return y < 1e-9 and (x < reach + 1e-9 or x > length - reach - 1e-9) end) }
model:force{ on = cdem.select.where(function(x, y) return y > height - 1e-9 and math.abs(x - length / 2) < 1e-9 end),
             force = {0, -load, 0} }
model:unbond{ on = cdem.select.box{ min = {notch_x - 1e-6, 0, 0}, max = {notch_x + 1e-6, notch_y, depth} },
              whole_faces = true }

model:relax{ residual = 1e-6, breaking = false }
local midspan = model:at("displacement.y", {length / 2, 1e-6, depth / 2})

local function picture(name, title)
  model:picture{ file = name .. ".png", title = title, size = {1600, 0} }
  model:save{ file = name .. ".vtu", series = "beam.pvd" }
end

local growth = { state = "not loaded", passes = {} }
if passes > 0 then
  growth = model:grow{ passes = passes, callback = function(pass)
    if pass.pass <= 3 then picture("pass_" .. pass.pass, "Crack after pass " .. pass.pass) end
  end }
  picture("crack", "Crack at the end")
end

local last = growth.passes[#growth.passes]
local path = last and last.path or {}
local reference = { {0.435, 0}, {0.449, 0.06}, {0.480, 0.09}, {0.510, 0.116}, {0.540, 0.142}, {0.570, 0.172}, {0.599, 0.21} }

-- Where the path crosses a height: x, or nil above its tip.
local function x_at(y)
  for i = 2, #path do
    local a, b = path[i - 1], path[i]
    if math.min(a[2], b[2]) <= y + 1e-9 and math.max(a[2], b[2]) >= y - 1e-9 and a[2] ~= b[2] then
      return a[1] + (b[1] - a[1]) * (y - a[2]) / (b[2] - a[2])
    end
  end
end

local sum, count = 0, 0
for _, point in ipairs(reference) do
  local x = x_at(point[2])
  if x then sum, count = sum + (x - point[1]) ^ 2, count + 1 end
end

if #path > 0 then
  local x, y, line, trial = {}, {}, {}, {}
  for i, p in ipairs(path) do x[i], y[i], line[i] = p[1], p[2], {p[1], p[2], depth} end
  for i, p in ipairs(reference) do trial[i] = {p[1], p[2], depth} end
  cdem.write_csv{ file = "path.csv", columns = { { name = "x_m", values = x }, { name = "y_m", values = y } } }
  model:picture{ file = "ux.png", colour = "displacement.x", deformation = 200, title = "Horizontal displacement",
                 size = {1600, 0}, broken_bonds = false }
  model:picture{ file = "path.png", title = "Path of the crack", size = {1600, 0}, broken_bonds = false,
                 lines = { { points = line, label = "cdem", colour = {0.75, 0, 0.38} },
                           { points = trial, label = "reference points", colour = {0, 0.38, 0.75}, dashed = true } } }
end

local paper = load == 2.5e4 or nil
cdem.report{
  { name = "crack_tip_x_m", value = last and last.tip[1], unit = "m", reference = paper and 0.599, kind = "trial" },
  { name = "crack_tip_y_m", value = last and last.tip[2], unit = "m", reference = paper and 0.21, kind = "trial" },
  { name = "path_rms_to_reference_m", value = count > 0 and math.sqrt(sum / count) or nil, unit = "m", reference = 0,
    kind = "trial",
    source = "horizontal distance at the heights of " .. count .. " of " .. #reference .. " reference points" },
  { name = "passes", value = #growth.passes, source = growth.state },
  { name = "elastic_midspan_uy_m", value = midspan, unit = "m",
    reference = paper and (support == "faces" and -3.136e-4 or -4.1e-4), kind = "fe",
    source = support == "faces" and "finite elements, end faces held" or "finite elements, still drifting with the mesh",
    tolerance = support == "faces" and 0.02 or nil },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 0.01 },
  { name = "steps", value = model.steps },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
