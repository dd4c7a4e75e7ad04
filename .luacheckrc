-- Lua 5.4, and only what a case script sees: no global of our own (cdem comes through require).
std = "lua54"
max_line_length = 130
