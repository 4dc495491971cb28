"""Tables of purchased parts; `designs.language.supplies` reads them."""
