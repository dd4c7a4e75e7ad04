local cdem = require "cdem"

-- example: cdem.parameter
local pressure = cdem.parameter{ name = "pressure", default = 30e6, range = {0, 1e9}, unit = "Pa", doc = "on the top face" }
local stage = cdem.parameter{ name = "until", default = "failure", choices = {"elastic", "failure"} }
cdem.log("pressure " .. pressure .. " Pa, until " .. stage) -- --set pressure=24e6 --set until=elastic
