"""The nouns: frozen values without behaviour beyond what they are."""
