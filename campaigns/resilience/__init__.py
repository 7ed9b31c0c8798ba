"""The experiments of paper 002: filters that resist outliers, references in double and the shipped code on the same realisations."""
