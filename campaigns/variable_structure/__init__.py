"""The variable-structure measurement system of paper 004 (Shen, Selezneva, Neusypin, Proletarsky, 2017) in double precision: the reference."""
