-- What the height of a drop test depends on: case.lua with one factor changed at a time.
--
--   ./cdem run examples/drop_test/factors.lua
--   ./cdem run examples/drop_test/factors.lua --set shape=accropode --set attitude=flat --set fineness=4
local cdem = require "cdem"

local shape = cdem.parameter{ name = "shape", default = "cube", choices = {"cube", "cubipod", "dolos", "tetrapod", "accropode"} }
local attitude = cdem.parameter{ name = "attitude", default = "edge", choices = {"flat", "edge", "corner"} }
local fineness = cdem.parameter{ name = "fineness", default = 3.0, range = {2, 30}, doc = "Dn over edge of the tets" }
local finer = cdem.parameter{ name = "finer", default = 1.6, range = {1, 4}, doc = "of the finer mesh; 1: none" }
local bisections = cdem.parameter{ name = "bisections", default = 2, range = {0, 20} }

local changes = {
  { "unchanged", {} },
  { "flat", { attitude = "flat" } },
  { "edge", { attitude = "edge" } },
  { "corner", { attitude = "corner" } },
  { "floor_rigid", { floor = "rigid" } },
  { "contact_half", { contact_stiffness = 0.5 } },
  { "contact_twice", { contact_stiffness = 2.0 } },
  { "contact_tenfold", { contact_stiffness = 10.0 } },
  { "strength_2_mpa", { tensile_strength = 2e6 } }, -- the faces of a coarse mesh store more than G_I at 5 MPa
  { "rate_effect", { rate_effect = true } },
  { "g_1000", { fracture_energy = 1000.0 } },
  { "brittle", { fracture_energy = 0.0 } },
  { "finer", { fineness = finer * fineness } },
}
local names, sets = {}, {}
for _, change in ipairs(changes) do
  local name, changed = change[1], change[2]
  if name ~= attitude and (name ~= "finer" or finer > 1) then
    local set = { shape = shape, attitude = attitude, fineness = fineness, bisections = bisections, pictures = false }
    for key, value in pairs(changed) do set[key] = value end
    names[#names + 1], sets[#sets + 1] = name, set
  end
end
local figures, first = {}, nil
for i, result in ipairs(cdem.sweep{ script = "case.lua", set = sets }) do
  local height = result.figures and result.figures.critical_height_m
  first = first or height
  figures[#figures + 1] = { name = names[i] .. "_m", value = height, unit = "m" }
  figures[#figures + 1] = { name = names[i] .. "_ratio", value = height and first and height / first }
  figures[#figures + 1] = { name = names[i] .. "_tets", value = result.figures and result.figures.tets }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
