"""The experiments of papers 000 and 001 (parametric synthesis of filters): references in double and the shipped filters on the same samples."""
